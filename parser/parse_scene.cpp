// SPDX-License-Identifier: GPL-3.0-or-later
// A scene file's items, what can be declared, and what is seen to once all is read.
#include "core/probe.h"
#include "core/scene_check.h"
#include "parser/blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

bool ends_with_pov(const std::string& file) {
    if (file.size() < 4) return false;
    std::string tail = file.substr(file.size() - 4);
    for (char& c : tail)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return tail == ".pov";
}

// POV-Ray's own defaults: without assumed_gamma it writes values as they are.
void start_povray(Parser& p) {
    p.scene.povray = true;
    p.scene.assumed_gamma = 0;
    p.settings.render.max_trace_level = 5;
}

bool is_black(const Texture& texture) {
    if (!is_plain(texture) || !texture.upper.empty()) return false;
    const Pigment& pigment = texture.pigment;
    return std::holds_alternative<UniformPattern>(pigment.pattern.kind) &&
           pnr::is_black(pigment.map.front().color.rgb) &&
           pigment.map.front().color.filter + pigment.map.front().color.transmit == 0;
}

bool has_texture(const Object& object) {
    return object.texture || std::ranges::any_of(object.children, has_texture);
}

// Gives #default's texture to the parts that have none and inherit none; those that show what they cut through go
// without. True if a part stayed black by that.
bool give_default_texture(const Texture& texture, Object& object) {
    if (object.texture || (object.cutaway_textures && has_texture(object))) return false;
    if (object.shape) object.texture = texture;
    bool black = object.shape && is_black(texture);
    for (Object& child : object.children) black |= give_default_texture(texture, child);
    return black;
}

// Lights that stand in unions become the scene's own, and so do the objects that lights look like.
void take_lights(Object& object, std::vector<LightSource>& lights) {
    for (LightSource& light : object.lights) lights.push_back(std::move(light));
    object.lights.clear();
    for (Object& child : object.children) take_lights(child, lights);
}

void add_light(Parser& p, const Token& word, LightSource light);

void add_object(Parser& p, const Token& word, Object object) {
    if (give_default_texture(p.default_texture, object))
        warn(p, word, "this object has no pigment and stays black",
             "give it one: pigment { rgb <1, 0.5, 0.2> }");
    std::vector<LightSource> lights;
    take_lights(object, lights);
    p.scene.objects.push_back(std::move(object));
    for (LightSource& light : lights) add_light(p, word, std::move(light));
}

void add_light(Parser& p, const Token& word, LightSource light) {
    const std::vector<Object> looks_like = std::move(light.looks_like);
    light.looks_like.clear();
    p.scene.lights.push_back(std::move(light));
    for (const Object& object : looks_like) add_object(p, word, object);
}

void parse_camera_item(Parser& p) {
    const Telling camera(p.in, Listener::camera);
    p.scene.camera = parse_camera(p);
    p.scene.has_camera = true;
}

bool is_unsupported_item(const Token& word) {
    switch (keyword_of(word)) {
    case "media"_kw:
        return true;
    default:
        return false;
    }
}

bool parse_atmosphere_item(Parser& p) {
    Atmosphere& air = p.scene.atmosphere;
    if (accept(p, "background"_kw))
        air.background = parse_background(p);
    else if (accept(p, "sky_sphere"_kw))
        air.sky = parse_sky_sphere(p);
    else if (accept(p, "fog"_kw))
        air.fogs.push_back(parse_fog(p));
    else if (accept(p, "rainbow"_kw))
        air.rainbows.push_back(parse_rainbow(p));
    else
        return false;
    return true;
}

void parse_scene_item(Parser& p) {
    const Token word = peek(p);
    if (auto object = parse_object(p)) return add_object(p, word, std::move(*object));
    if (accept(p, "light_source"_kw)) return add_light(p, word, parse_light_source(p));
    if (accept(p, "camera"_kw)) return parse_camera_item(p);
    if (parse_atmosphere_item(p)) return;
    if (accept(p, "global_settings"_kw)) return parse_global_settings(p);
    if (accept(p, "default"_kw)) { // POV-Ray takes #default without its mark as well
        open_block(p, "default");
        parse_default_block(p);
        close_block(p);
        return;
    }
    if (is_unsupported_item(word)) {
        warn_unsupported(p, next(p), token_text(p, word, false), "it is left out");
        return skip_block(p, token_text(p, word, false));
    }
    if (accept(p, ';')) return;
    unexpected(p, "a scene",
               {"camera"_kw, "light_source"_kw, "object"_kw, "sphere"_kw, "box"_kw, "plane"_kw, "cylinder"_kw,
                "cone"_kw, "torus"_kw, "disc"_kw, "triangle"_kw, "smooth_triangle"_kw, "mesh"_kw, "mesh2"_kw,
                "bicubic_patch"_kw, "union"_kw, "background"_kw, "global_settings"_kw});
}

std::string name_of(const Object& object) {
    const std::string what = !object.name.empty() ? object.name
                             : object.shape       ? std::string(shape_name(*object.shape))
                                                  : "solid";
    return fmt::format("`{}` of line {}", what, object.said_at.line);
}

// Places inside solids: what is seen of the scene then surprises.
void check_insides(Parser& p, const Token& end) {
    const auto about_camera = solids_about(p.scene.objects, p.scene.camera.location);
    for (const Object* solid : about_camera) {
        const Bounds box = object_bounds(*solid);
        if (!std::isfinite(glm::length(box.high - box.low))) continue;
        warn(p, end, fmt::format("the camera is inside {}", name_of(*solid)),
             "move it out; or, if the scene is to be seen from within, say `hollow`: fog is not seen in what is "
             "not");
        break;
    }
    for (const LightSource& light : p.scene.lights) {
        if (light.emitter || light.shadowless) continue;
        for (const Object* solid : solids_about(p.scene.objects, light.position)) {
            if (!is_opaque(*solid) || std::ranges::find(about_camera, solid) != about_camera.end()) continue;
            warn(p, end,
                 fmt::format("the light of line {} is inside {}, which is opaque", light.said_at.line,
                             name_of(*solid)),
                 "move it out, or give the object `no_shadow`; `looks_like` does that");
            break;
        }
    }
}

void check_whole_scene(Parser& p) {
    const Token& end = peek(p);
    if (!p.scene.has_camera)
        warn(p, end, "the scene has no camera: it is seen from the origin along z",
             "add one: camera { location <0, 2, -8> look_at <0, 1, 0> }");
    if (p.scene.lights.empty() && !p.scene.objects.empty())
        warn(p, end, "the scene has no light", "add one: light_source { <5, 10, -10>, rgb 1 }");
    if (p.in.errors == 0) check_insides(p, end);
}

// `texture {...} texture {...}`: layers.
// peek_operator: the declaration must end before a directive behind it runs.
Texture parse_layers(Parser& p) {
    Object bearer;
    while (is(peek_operator(p), "texture"_kw)) parse_object_modifier(p, bearer);
    return bearer.texture.value_or(p.default_texture);
}

} // namespace

void parse_scene(Parser& p) {
    if (ends_with_pov(p.scene.file)) start_povray(p);
    for (bool ended = false; !ended;) {
        try {
            ended = at_end(p); // a macro may fail here already
            if (!ended) parse_scene_item(p);
        } catch (const ParseFailure&) {
            recover_statement(p);
        }
    }
    resolve_paint(p);
    p.scene.version = p.in.version;
    p.scene.noise_generator = scene_noise_generator(p);
    check_whole_scene(p);
    warn_unused(p);
}

std::optional<DeclaredBlock> parse_declared_block(Parser& p) {
    const Token word = peek(p);
    if (auto object = parse_object(p)) return DeclaredBlock(std::move(*object));
    switch (keyword_of(word)) {
    case "texture"_kw:
        return parse_layers(p);
    case "pigment"_kw:
        next(p);
        return parse_pigment(p, top_layer(p.default_texture).pigment);
    case "finish"_kw:
        next(p);
        return parse_finish(p, top_layer(p.default_texture).finish);
    case "interior"_kw:
        next(p);
        return parse_interior(p, Interior{});
    case "material"_kw:
        next(p);
        return parse_material(p);
    case "color_map"_kw:
        next(p);
        return parse_color_map(p);
    case "normal"_kw:
        next(p);
        return parse_normal(p, top_layer(p.default_texture).normal.value_or(Normal{}));
    case "normal_map"_kw:
        next(p);
        return parse_normal_map(p);
    case "slope_map"_kw:
        next(p);
        return parse_slope_map(p);
    case "texture_map"_kw:
        next(p);
        return parse_texture_map(p);
    case "pigment_map"_kw:
        next(p);
        return parse_pigment_map(p);
    case "light_source"_kw:
        next(p);
        return parse_light_source(p);
    case "camera"_kw: {
        const Telling camera(p.in, Listener::camera);
        next(p);
        return parse_camera(p);
    }
    case "sky_sphere"_kw:
        next(p);
        return parse_sky_sphere(p);
    case "fog"_kw:
        next(p);
        return parse_fog(p);
    case "rainbow"_kw:
        next(p);
        return parse_rainbow(p);
    case "transform"_kw:
        next(p);
        return parse_transform(p);
    case "npr"_kw: {
        const Telling painters(p.in, Listener::paint);
        next(p);
        PaintWord paint;
        parse_npr(p, paint);
        return paint;
    }
    default:
        break;
    }
    switch (keyword_of(word)) {
    case "media"_kw:
    case "density"_kw:
    case "density_map"_kw:
    case "warp"_kw:
        warn_unsupported(p, next(p), token_text(p, word, false), "it is left out");
        skip_block(p, token_text(p, word, false));
        return SkippedBlock{token_text(p, word, false)};
    default:
        return std::nullopt;
    }
}

void parse_default_block(Parser& p) {
    while (!at(p, '}') && !at_end(p)) {
        Texture& texture = p.default_texture;
        TextureLayer& layer = top_layer(texture);
        if (accept(p, "texture"_kw))
            texture = parse_texture(p, texture);
        else if (accept(p, "pigment"_kw))
            layer.pigment = parse_pigment(p, layer.pigment);
        else if (accept(p, "finish"_kw))
            layer.finish = parse_finish(p, layer.finish);
        else if (accept(p, "npr"_kw))
            parse_npr(p, p.paint_defaults);
        else if (accept(p, "camera"_kw))
            skip_block(p, "camera");
        else if (accept(p, "normal"_kw))
            layer.normal = parse_normal(p, layer.normal.value_or(Normal{}));
        else if (accept(p, "radiosity"_kw))
            skip_block(p, "radiosity");
        else
            unexpected(p, "#default", {"texture"_kw, "pigment"_kw, "finish"_kw, "npr"_kw});
    }
}

} // namespace pnr
