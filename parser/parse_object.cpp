// SPDX-License-Identifier: GPL-3.0-or-later
// Object statements: the word, the shape's own items, then modifiers in any order.
#include "parser/blocks.h"
#include "parser/content.h"
#include "parser/suggest.h"

#include <algorithm>
#include <array>

namespace pnr {

namespace {

using ShapeParser = Shape (*)(Parser&);

// The table of objects: a word and the function that reads what is its own.
ShapeParser find_shape_parser(const Token& word) {
    switch (keyword_of(word)) {
    case "sphere"_kw:
        return parse_sphere;
    case "box"_kw:
        return parse_box;
    case "plane"_kw:
        return parse_plane;
    case "cylinder"_kw:
        return parse_cylinder;
    case "cone"_kw:
        return parse_cone;
    case "torus"_kw:
        return parse_torus;
    case "disc"_kw:
        return parse_disc;
    case "triangle"_kw:
        return parse_triangle;
    case "smooth_triangle"_kw:
        return parse_smooth_triangle;
    case "mesh"_kw:
        return parse_mesh;
    case "mesh2"_kw:
        return parse_mesh2;
    case "bicubic_patch"_kw:
        return parse_bicubic_patch;
    case "isosurface"_kw:
        return parse_isosurface;
    case "blob"_kw:
        return parse_blob;
    case "height_field"_kw:
        return parse_height_field;
    case "julia_fractal"_kw:
        return parse_julia_fractal;
    case "parametric"_kw:
        return parse_parametric;
    case "quadric"_kw:
        return parse_quadric;
    case "cubic"_kw:
        return parse_cubic;
    case "quartic"_kw:
        return parse_quartic;
    case "poly"_kw:
        return parse_poly;
    case "polynomial"_kw:
        return parse_polynomial;
    case "superellipsoid"_kw:
        return parse_superellipsoid;
    case "ovus"_kw:
        return parse_ovus;
    case "lathe"_kw:
        return parse_lathe;
    case "sor"_kw:
        return parse_sor;
    case "prism"_kw:
        return parse_prism;
    case "sphere_sweep"_kw:
        return parse_sphere_sweep;
    case "polygon"_kw:
        return parse_polygon;
    case "text"_kw:
        return parse_text;
    default:
        return nullptr;
    }
}

bool is_group(const Token& word) {
    switch (keyword_of(word)) {
    case "union"_kw:
    case "merge"_kw:
    case "difference"_kw:
    case "intersection"_kw:
    case "light_group"_kw:
        return true;
    default:
        return false;
    }
}

// ---- modifiers
// --------------------------------------------------------------------------------------------------

// What `pigment`, `normal` and `finish` of an object change.
TextureLayer& own_layer(Parser& p, Object& object) {
    if (!object.texture) object.texture = p.default_texture;
    return top_layer(*object.texture);
}

// A second texture lies on the first, as a layer.
void add_texture(Parser& p, Object& object) {
    const Texture texture = parse_texture(p, p.default_texture);
    if (object.texture)
        add_layer(p, *object.texture, texture, true);
    else
        object.texture = texture;
    if (object.uv_mapping) map_by_uv(*object.texture);
}

void add_material(Parser& p, Object& object) {
    SaidMaterial material;
    if (const auto* declared = accept_declared<SaidMaterial>(p))
        material = *declared;
    else
        material = parse_material(p);
    if (material.texture) object.texture = material.texture;
    if (material.interior_texture) object.interior_texture = material.interior_texture;
    if (material.interior) object.interior = *material.interior;
}

bool parse_texture_modifier(Parser& p, Object& object) {
    switch (keyword_of(peek(p))) {
    case "texture"_kw:
        next(p), add_texture(p, object);
        return true;
    case "pigment"_kw: {
        next(p);
        TextureLayer& layer = own_layer(p, object);
        layer.pigment = parse_pigment(p, layer.pigment);
        if (object.uv_mapping) map_by_uv(*object.texture);
        return true;
    }
    case "finish"_kw: {
        next(p);
        TextureLayer& layer = own_layer(p, object);
        layer.finish = parse_finish(p, layer.finish);
        return true;
    }
    case "interior"_kw:
        next(p), object.interior = parse_interior(p, object.interior.value_or(Interior{}));
        return true;
    case "material"_kw:
        next(p), add_material(p, object);
        return true;
    case "normal"_kw: {
        next(p);
        TextureLayer& layer = own_layer(p, object);
        layer.normal = parse_normal(p, layer.normal.value_or(Normal{}));
        if (object.uv_mapping) map_by_uv(*object.texture);
        return true;
    }
    case "interior_texture"_kw:
        next(p), object.interior_texture = parse_texture(p, p.default_texture);
        return true;
    case "uv_mapping"_kw:
        next(p), object.uv_mapping = parse_optional_bool(p);
        return true;
    default:
        return false;
    }
}

Mesh* mesh_from_file(Object& object) {
    Mesh* mesh = object.shape ? std::get_if<Mesh>(&*object.shape) : nullptr;
    return mesh && !mesh->file.empty() ? mesh : nullptr;
}

// Before a copy of it is made.
void charge_copy(Parser& p, const Token& at, const Weight& weight) {
    check_weight(p, at, weight);
    charge(p, at, weight.bytes);
}

// `clipped_by { ... }` or `bounded_by { ... }`: objects, then transforms of all of them; or the other's word,
// for the same objects.
void parse_limit(Parser& p, std::string_view what, Keyword other_word, std::vector<Object>& limits,
                 const std::vector<Object>& others) {
    std::vector<Object> said;
    block(p, what, [&] {
        const Token word = peek(p);
        if (Transform transform; accept_transform(p, transform))
            for (Object& object : said) apply_transform(transform, object);
        else if (accept(p, other_word))
            said.insert(said.end(), others.begin(), others.end());
        else if (auto object = parse_object(p))
            said.push_back(std::move(*object));
        else if (const auto* declared = accept_declared<Object>(p))
            charge_copy(p, word, weight_of(*declared)), said.push_back(*declared);
        else
            unexpected(p, what, {other_word});
    });
    limits.insert(limits.end(), std::make_move_iterator(said.begin()), std::make_move_iterator(said.end()));
}

bool parse_flag(Parser& p, Object& object) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "no_shadow"_kw:
        next(p), object.no_shadow = true;
        return true;
    case "no_image"_kw:
        next(p), object.no_image = parse_optional_bool(p);
        return true;
    case "no_reflection"_kw:
        next(p), object.no_reflection = parse_optional_bool(p);
        return true;
    case "hollow"_kw:
        next(p), object.hollow = parse_optional_bool(p);
        return true;
    case "inverse"_kw:
        next(p), object.inverse = !object.inverse;
        return true;
    case "no_radiosity"_kw:
        next(p), object.no_radiosity = parse_optional_bool(p);
        return true;
    case "double_illuminate"_kw:
        next(p), object.double_illuminate = parse_optional_bool(p);
        return true;
    case "split_union"_kw:
    case "sturm"_kw:
    case "hierarchy"_kw:
        next(p), parse_optional_bool(p);
        return true;
    case "cutaway_textures"_kw:
        next(p), object.cutaway_textures = parse_optional_bool(p);
        return true;
    case "bounded_by"_kw:
        next(p), parse_limit(p, "bounded_by", "clipped_by"_kw, object.bounds, object.clips);
        return true;
    case "clipped_by"_kw:
        next(p), parse_limit(p, "clipped_by", "bounded_by"_kw, object.clips, object.bounds);
        return true;
    case "open"_kw:
        if (Cylinder* cylinder = object.shape ? std::get_if<Cylinder>(&*object.shape) : nullptr)
            return next(p), cylinder->open = true;
        if (Cone* cone = object.shape ? std::get_if<Cone>(&*object.shape) : nullptr)
            return next(p), cone->open = true;
        if (Prism* prism = object.shape ? std::get_if<Prism>(&*object.shape) : nullptr)
            return next(p), prism->open = true;
        if (Sor* sor = object.shape ? std::get_if<Sor>(&*object.shape) : nullptr)
            return next(p), sor->open = true;
        return false;
    case "tolerance"_kw: // hits are as exact as numbers are
        if (object.shape && std::holds_alternative<SphereSweep>(*object.shape)) return next(p), parse_float(p), true;
        return false;
    case "smooth"_kw:
        if (Mesh* mesh = mesh_from_file(object)) return next(p), mesh->smooth = parse_optional_bool(p), true;
        return false;
    case "repair"_kw:
        if (Mesh* mesh = mesh_from_file(object)) return next(p), mesh->repair = parse_optional_bool(p), true;
        return false;
    case "subdivide"_kw:
        if (Mesh* mesh = mesh_from_file(object))
            return next(p), mesh->subdivide = parse_int(p, 0, 8, "`subdivide`"), true;
        return false;
    case "simplify"_kw:
        if (Mesh* mesh = mesh_from_file(object))
            return next(p), mesh->simplify = parse_int(p, 4, 1 << 26, "`simplify`"), true;
        return false;
    default:
        return false;
    }
}

} // namespace

bool parse_object_modifier(Parser& p, Object& object) {
    if (Transform transform; accept_transform(p, transform)) return apply_transform(transform, object), true;
    if (parse_texture_modifier(p, object) || parse_flag(p, object)) return true;
    if (accept(p, "photons"_kw)) return object.photons = parse_object_photons(p), true;
    if (!accept(p, "npr"_kw)) return false;
    if (!object.npr) object.npr.emplace();
    parse_npr(p, *object.npr);
    return true;
}

namespace {

[[noreturn]] void unexpected_in_object(Parser& p, std::string_view what) {
    unexpected(p, what,
               {"texture"_kw, "pigment"_kw, "finish"_kw, "interior"_kw, "material"_kw, "npr"_kw, "photons"_kw,
                "translate"_kw, "rotate"_kw, "scale"_kw, "matrix"_kw, "transform"_kw, "no_shadow"_kw,
                "no_image"_kw, "no_reflection"_kw, "hollow"_kw, "inverse"_kw});
}

bool at_declared_object(Parser& p, Object& object) {
    const Token name = peek(p);
    const auto* declared = accept_declared<Object>(p);
    if (!declared) return false;
    charge_copy(p, name, weight_of_parts(*declared)); // itself counts at its end
    object = *declared;
    object.name = token_text(p, name, false);
    return true;
}

// A shape's statement behind its word: its own items, or a declared object of any shape, then modifiers.
Object parse_shape_statement(Parser& p, const Token& word, ShapeParser parse_shape) {
    Object object;
    const std::string what = token_text(p, word, false);
    bool started = false;
    block(p, what, [&] {
        if (!started) {
            started = true;
            if (!at_declared_object(p, object)) object.shape = parse_shape(p);
        } else if (!parse_object_modifier(p, object))
            unexpected_in_object(p, what);
    });
    if (!started) error(p, word, "`" + what + "` is empty", "it needs its measures: " + syntax_of(what));
    return object;
}

// Neither an object nor the name of one.
[[noreturn]] void missing_object(Parser& p) {
    const Token found = peek(p);
    if (found.kind == TokenKind::word && !is_keyword(found.symbol)) {
        if (!is_declared(p.in, found.symbol)) take_variable(p); // says so
        unexpected(p, "object", {});
    }
    fail(p, found, "`object` needs a declared object's name, or an object, found " + token_text(p, found),
         "declare it first: #declare Name = sphere { ... }");
}

// `object { Name ... }` or `object { sphere {...} ... }`.
Object parse_object_reference(Parser& p) {
    Object object;
    bool started = false;
    block(p, "object", [&] {
        if (!started) {
            started = true;
            if (at_declared_object(p, object)) return;
            if (auto inner = parse_object(p))
                object = std::move(*inner);
            else if (accept(p, "light_source"_kw))
                object.lights.push_back(parse_light_source(p));
            else if (const auto* light = accept_declared<LightSource>(p))
                object.lights.push_back(*light);
            else
                missing_object(p);
        } else if (!parse_object_modifier(p, object))
            unexpected_in_object(p, "object");
    });
    return object;
}

bool parse_group_child(Parser& p, Object& group) {
    const Token word = peek(p);
    if (accept(p, "light_source"_kw))
        group.lights.push_back(parse_light_source(p));
    else if (const auto* light = accept_declared<LightSource>(p))
        charge_copy(p, word, weight_of(*light)), group.lights.push_back(*light);
    else if (auto child = parse_object(p))
        group.children.push_back(std::move(*child));
    else if (const auto* declared = accept_declared<Object>(p)) {
        charge_copy(p, word, weight_of(*declared));
        group.children.push_back(*declared);
        group.children.back().name = token_text(p, word, false);
    } else
        return false;
    return true;
}

Combination combination_of(const Token& word) {
    if (is(word, "merge"_kw)) return Combination::merge;
    if (is(word, "intersection"_kw)) return Combination::intersect;
    return is(word, "difference"_kw) ? Combination::differ : Combination::unite;
}

// What cannot be meant: nothing in it, or nothing to take away.
void check_group(Parser& p, const Token& word, const Object& group) {
    const std::size_t parts = group.children.size() + group.lights.size();
    if (parts == 0) warn(p, word, token_text(p, word) + " is empty: there is nothing in it");
    if (parts == 1 && (is(word, "difference"_kw) || is(word, "intersection"_kw)))
        warn(p, word, token_text(p, word) + " has only one object: nothing is cut");
}

// union, merge, intersection, difference, light_group.
Object parse_group(Parser& p, const Token& word) {
    Object group;
    const std::string what = token_text(p, word, false);
    group.combination = combination_of(word);
    group.global_lights = !is(word, "light_group"_kw); // POV-Ray's default
    block(p, what, [&] {
        if (parse_group_child(p, group) || parse_object_modifier(p, group)) return;
        if (is(word, "light_group"_kw) && accept(p, "global_lights"_kw))
            group.global_lights = parse_bool(p);
        else
            unexpected_in_object(p, what);
    });
    check_group(p, word, group);
    if (!is(word, "light_group"_kw)) return group;
    group.light_group = ++p.light_groups;
    for (LightSource& light : group.lights) light.group = group.light_group;
    return group;
}

} // namespace

std::optional<Object> parse_object(Parser& p) {
    const Token word = peek(p);
    Object object;
    if (const ShapeParser parse_shape = find_shape_parser(word))
        object = parse_shape_statement(p, next(p), parse_shape);
    else if (is_group(word))
        object = parse_group(p, next(p));
    else if (accept(p, "object"_kw))
        object = parse_object_reference(p);
    else
        return std::nullopt;
    object.said_at = source_ref(p, word);
    constexpr std::size_t room = sizeof(Object) * 3 / 2; // with what lists of objects keep free
    charge(p, word, room + (object.texture ? weight_of(*object.texture).bytes : 0));
    return object;
}

PhotonRoles parse_object_photons(Parser& p) {
    PhotonRoles roles;
    block(p, "photons", [&] {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "specular_probability"_kw:
            next(p), roles.specular_probability = parse_float_in(p, 0, 1, "`specular_probability`");
            return;
        case "absorption_probability"_kw:
            next(p), roles.absorption_probability = parse_float_in(p, 0, 1, "`absorption_probability`");
            return;
        case "target"_kw:
            next(p), roles.target = true;
            if (at_expression(p)) parse_float(p); // POV-Ray's spacing multiplier: photons go everywhere here
            return;
        case "reflection"_kw:
            next(p), roles.reflection = parse_optional_bool(p);
            return;
        case "refraction"_kw:
            next(p), roles.refraction = parse_optional_bool(p);
            return;
        case "collect"_kw:
            next(p), roles.collect = parse_optional_bool(p);
            return;
        case "pass_through"_kw:
            next(p), roles.pass_through = parse_optional_bool(p);
            return;
        default:
            unexpected(p, "photons",
                       {"specular_probability"_kw, "absorption_probability"_kw, "target"_kw, "reflection"_kw,
                        "refraction"_kw, "collect"_kw, "pass_through"_kw});
        }
    });
    return roles;
}

} // namespace pnr
