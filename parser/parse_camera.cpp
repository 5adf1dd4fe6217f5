// SPDX-License-Identifier: GPL-3.0-or-later
// The camera. Its rules were found by asking POV-Ray 3.7.0.10, with a room whose walls show where each ray
// ends: the order of the items does not matter; `angle` sets the length of `direction`; then `look_at` turns
// the frame about `sky` and keeps the lengths and the handedness; transforms come last. An orthographic
// camera without `right` and `up`, or with `angle`, shows what a perspective one shows at the distance of
// look_at (by default <0, 0, 1>).
#include "core/mesh_view.h"
#include "parser/blocks.h"

#include <cmath>

namespace pnr {

namespace {

struct SaidCamera {
    Camera camera;
    Vec3 sky{0, 1, 0}, look_at{0, 0, 1};
    bool looks = false, sized = false; // look_at; right or up
    bool copied = false;               // a declared camera started it
    std::optional<double> angle, v_angle;
    Token angle_at;
    std::optional<Vec3> focal_point;
    Transform transform;
};

void apply_angle(Camera& camera, double degrees) {
    const double length = glm::length(camera.right) / std::tan(degrees * pi / 360) / 2;
    camera.direction *= length / glm::length(camera.direction);
}

void apply_look_at(Camera& camera, Vec3 look_at, Vec3 sky) {
    const double direction_length = glm::length(camera.direction);
    const double up_length = glm::length(camera.up);
    const double right_length = glm::length(camera.right);
    const bool mirrored = !(glm::dot(glm::cross(camera.up, camera.direction), camera.right) > 0);
    const Vec3 forward = glm::normalize(look_at - camera.location);
    Vec3 right = glm::cross(sky, forward);
    if (!(glm::length(right) > 1e-10 * glm::length(sky))) right = camera.right; // straight along the sky
    right = glm::normalize(right);
    camera.up = glm::cross(forward, right) * up_length;
    camera.direction = forward * direction_length;
    camera.right = right * (mirrored ? -right_length : right_length);
}

void parse_projection(Parser& p, const Token& word, SaidCamera& said) {
    Camera& camera = said.camera;
    next(p);
    camera.mesh = nullptr;
    switch (keyword_of(word)) {
    case "orthographic"_kw:
        camera.projection = Projection::orthographic;
        break;
    case "fisheye"_kw:
        camera.projection = Projection::fisheye;
        break;
    case "ultra_wide_angle"_kw:
        camera.projection = Projection::ultra_wide_angle;
        break;
    case "omnimax"_kw:
        camera.projection = Projection::omnimax;
        break;
    case "panoramic"_kw:
        camera.projection = Projection::panoramic;
        break;
    case "spherical"_kw:
        camera.projection = Projection::spherical;
        break;
    case "cylinder"_kw: {
        constexpr Projection cylinders[] = {Projection::cylinder_1, Projection::cylinder_2,
                                            Projection::cylinder_3, Projection::cylinder_4};
        camera.projection = cylinders[parse_int(p, 1, 4, "the kind of a cylinder camera") - 1];
        break;
    }
    default:
        camera.projection = Projection::perspective;
    }
}

// `mesh_camera { rays kind [distance] mesh ... [smooth] }`
void parse_mesh_camera(Parser& p, Camera& camera) {
    std::vector<MeshViewPart> parts;
    MeshRays rays = MeshRays::by_index;
    bool smooth = false, numbers = false;
    const Token opener = peek(p);
    block(p, "mesh_camera", [&] {
        const Token word = peek(p);
        if (!numbers) {
            numbers = true;
            parse_float(p), accept_comma(p); // rays a pixel: more come with antialiasing
            const int kind = parse_int(p, 0, 3, "the distribution of a mesh_camera");
            rays = kind == 3 ? MeshRays::by_uv : kind == 0 ? MeshRays::by_index : MeshRays::in_a_row;
            accept_comma(p);
            if (at_expression(p)) parse_float(p), accept_comma(p); // how far POV-Ray looks for a face
        } else if (accept(p, "smooth"_kw)) {
            smooth = true;
        } else {
            std::optional<Object> object = parse_object(p);
            if (!object)
                if (const auto* declared = accept_declared<Object>(p)) object = *declared;
            const Mesh* mesh = object && object->shape ? std::get_if<Mesh>(&*object->shape) : nullptr;
            if (!mesh || !mesh->data) fail(p, word, "`mesh_camera` needs meshes of the scene's text");
            parts.push_back({mesh->data, object->transform});
        }
    });
    if (parts.empty()) fail(p, opener, "`mesh_camera` needs a mesh");
    camera.projection = Projection::mesh;
    camera.mesh = make_mesh_view(parts, rays, smooth);
}

void parse_angle(Parser& p, SaidCamera& said) {
    const Token at = peek(p);
    said.angle = parse_float_in(p, 0, 1e6, "`angle`");
    accept_comma(p);
    if (at_expression(p)) said.v_angle = parse_float_in(p, 0, 1e6, "`angle`");
    said.angle_at = at;
}

void parse_blur_samples(Parser& p, Lens& lens) {
    const int first = parse_int(p, 1, 1 << 20, "`blur_samples`");
    accept_comma(p);
    lens.samples_min = 0, lens.samples_max = first;
    if (at_expression(p)) lens.samples_min = first, lens.samples_max = parse_int(p, 1, 1 << 20, "`blur_samples`");
}

bool parse_lens_word(Parser& p, SaidCamera& said) {
    const Token word = peek(p);
    Lens& lens = said.camera.lens;
    switch (keyword_of(word)) {
    case "aperture"_kw:
        next(p), lens.aperture = parse_float_in(p, 0, 1e100, "`aperture`");
        return true;
    case "blur_samples"_kw:
        next(p), parse_blur_samples(p, lens);
        return true;
    case "confidence"_kw:
        next(p), lens.confidence = parse_float_in(p, 0, 0.9999999, "`confidence`");
        return true;
    case "variance"_kw:
        next(p), lens.variance = parse_float_in(p, 0, 1, "`variance`");
        return true;
    case "focal_point"_kw:
        next(p), said.focal_point = parse_vector(p);
        return true;
    case "bokeh"_kw:
        warn_unsupported(p, next(p), "bokeh", "the lens is evenly bright");
        skip_block(p, "bokeh");
        return true;
    default:
        return false;
    }
}

Vec3 parse_frame_vector(Parser& p, std::string_view what) {
    const Token at = peek(p);
    const Vec3 v = parse_vector(p);
    if (v == Vec3(0)) fail(p, at, std::string(what) + " of a camera must not be zero");
    return v;
}

bool parse_camera_word(Parser& p, SaidCamera& said) {
    const Token word = peek(p);
    Camera& camera = said.camera;
    switch (keyword_of(word)) {
    case "perspective"_kw:
    case "orthographic"_kw:
    case "fisheye"_kw:
    case "ultra_wide_angle"_kw:
    case "omnimax"_kw:
    case "panoramic"_kw:
    case "spherical"_kw:
    case "cylinder"_kw:
        parse_projection(p, word, said);
        return true;
    case "mesh_camera"_kw:
        next(p), parse_mesh_camera(p, camera);
        return true;
    case "location"_kw:
        next(p), camera.location = parse_vector(p);
        return true;
    case "direction"_kw:
        next(p), camera.direction = parse_frame_vector(p, "`direction`");
        return true;
    case "right"_kw:
        next(p), camera.right = parse_frame_vector(p, "`right`"), said.sized = true;
        return true;
    case "up"_kw:
        next(p), camera.up = parse_frame_vector(p, "`up`"), said.sized = true;
        return true;
    case "sky"_kw:
        next(p), said.sky = parse_frame_vector(p, "`sky`");
        return true;
    case "look_at"_kw:
        next(p), said.look_at = parse_vector(p), said.looks = true;
        return true;
    case "angle"_kw:
        next(p), parse_angle(p, said);
        return true;
    case "normal"_kw:
        warn_unsupported(p, next(p), "normal of a camera", "rays go straight");
        skip_block(p, "normal");
        return true;
    default:
        return parse_lens_word(p, said) || accept_transform(p, said.transform);
    }
}

// What `angle` means to each type. Of a straight picture it is the angle across, which sets the length of `direction`.
void finish_angle(Parser& p, SaidCamera& said) {
    Camera& c = said.camera;
    const double aspect = glm::length(c.up) / glm::length(c.right);
    switch (c.projection) {
    case Projection::perspective:
    case Projection::orthographic:
        if (!said.angle) return;
        if (*said.angle >= 180) fail(p, said.angle_at, "`angle` must lie between 0 and 180 degrees");
        if (*said.angle == 0)
            warn(p, said.angle_at, "`angle 0` is ignored"), said.angle.reset();
        else
            apply_angle(c, *said.angle);
        return;
    case Projection::spherical:
        if (said.angle || !said.copied) c.h_angle = said.angle.value_or(360), c.v_angle = said.v_angle.value_or(c.h_angle / 2);
        return;
    case Projection::ultra_wide_angle:
        if (said.angle || !said.copied) c.h_angle = said.angle.value_or(90);
        c.v_angle = c.h_angle * aspect;
        return;
    default:
        if (said.angle || !said.copied) c.h_angle = c.v_angle = said.angle.value_or(90);
    }
}

void finish_camera(Parser& p, const Token& at, SaidCamera& said) {
    Camera& camera = said.camera;
    finish_angle(p, said);
    const double distance = glm::length(said.look_at - camera.location);
    if (said.looks) {
        if (!(distance > 0)) fail(p, at, "`location` and `look_at` of a camera must differ");
        if (glm::length(glm::cross(said.sky, said.look_at - camera.location)) <
            1e-10 * glm::length(said.sky) * distance)
            warn(p, at, "the camera looks along its `sky`: which way is up is left to chance",
                 "give it another, for example: sky z");
        apply_look_at(camera, said.look_at, said.sky);
    }
    if (camera.projection == Projection::orthographic && (said.angle || !said.sized) && distance > 0) {
        const double scale = distance / glm::length(camera.direction);
        camera.right *= scale;
        camera.up *= scale;
    }
    if (said.focal_point)
        camera.lens.distance =
            std::abs(glm::dot(*said.focal_point - camera.location, glm::normalize(camera.direction)));
    apply_transform(said.transform, camera);
}

} // namespace

Camera parse_camera(Parser& p) {
    SaidCamera said;
    const Token opener = peek(p);
    block(p, "camera", [&] {
        if (const auto* declared = accept_declared<Camera>(p)) {
            said.camera = *declared;
            said.copied = true;
        } else if (parse_camera_word(p, said))
            accept_comma(p);
        else
            unexpected(p, "camera",
                       {"location"_kw, "look_at"_kw, "right"_kw, "up"_kw, "direction"_kw, "sky"_kw,
                        "angle"_kw, "perspective"_kw, "orthographic"_kw, "translate"_kw, "rotate"_kw,
                        "scale"_kw});
    });
    if (said.copied) said.sized = true; // its size was settled where it was declared
    finish_camera(p, opener, said);
    return said.camera;
}

} // namespace pnr
