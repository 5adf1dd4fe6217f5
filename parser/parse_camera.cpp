// SPDX-License-Identifier: GPL-3.0-or-later
// The camera. Its rules were found by asking POV-Ray 3.7.0.10, with a room whose walls show where each ray
// ends: the order of the items does not matter; `angle` sets the length of `direction`; then `look_at` turns
// the frame about `sky` and keeps the lengths and the handedness; transforms come last. An orthographic
// camera without `right` and `up`, or with `angle`, shows what a perspective one shows at the distance of
// look_at (by default <0, 0, 1>).
#include "parser/blocks.h"

#include <cmath>

namespace pnr {

namespace {

struct SaidCamera {
    Camera camera;
    Vec3 sky{0, 1, 0}, look_at{0, 0, 1};
    bool looks = false, sized = false; // look_at; right or up
    bool replaced = false;             // its type is one that we lack
    std::optional<double> angle;
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
    if (is(word, "perspective"_kw))
        camera.projection = Projection::perspective;
    else if (is(word, "orthographic"_kw))
        camera.projection = Projection::orthographic;
    else {
        said.replaced = true;
        warn_unsupported(p, word, "camera type " + token_text(p, word, false),
                         "a perspective camera takes its place");
        skip_argument(p, token_text(p, word, false));
    }
}

void parse_angle(Parser& p, SaidCamera& said) {
    const Token at = peek(p);
    const double degrees = parse_float(p);
    accept_comma(p);
    if (at_expression(p)) parse_float(p);        // the vertical angle of spherical cameras
    if (said.replaced && degrees >= 180) return; // of a camera type that sees further around
    if (!(degrees >= 0 && degrees < 180)) fail(p, at, "`angle` must lie between 0 and 180 degrees");
    if (degrees == 0)
        warn(p, at, "`angle 0` is ignored");
    else
        said.angle = degrees;
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
    case "mesh_camera"_kw:
        parse_projection(p, word, said);
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
    case "aperture"_kw:
        warn_unsupported(p, next(p), "focal blur", "everything is sharp");
        parse_float(p);
        return true;
    case "blur_samples"_kw:
        next(p), parse_float(p), accept_comma(p);
        if (at_expression(p)) parse_float(p);
        return true;
    case "confidence"_kw:
    case "variance"_kw:
        next(p), parse_float(p);
        return true;
    case "focal_point"_kw:
        next(p), parse_vector(p);
        return true;
    case "normal"_kw:
        warn_unsupported(p, next(p), "normal of a camera", "rays go straight");
        skip_block(p, "normal");
        return true;
    default:
        return accept_transform(p, said.transform);
    }
}

void finish_camera(Parser& p, const Token& at, SaidCamera& said) {
    Camera& camera = said.camera;
    if (said.angle) apply_angle(camera, *said.angle);
    const double distance = glm::length(said.look_at - camera.location);
    if (said.looks) {
        if (!(distance > 0)) fail(p, at, "`location` and `look_at` of a camera must differ");
        apply_look_at(camera, said.look_at, said.sky);
    }
    if (camera.projection == Projection::orthographic && (said.angle || !said.sized) && distance > 0) {
        const double scale = distance / glm::length(camera.direction);
        camera.right *= scale;
        camera.up *= scale;
    }
    apply_transform(said.transform, camera);
}

} // namespace

Camera parse_camera(Parser& p) {
    SaidCamera said;
    const Token opener = peek(p);
    bool copied = false;
    block(p, "camera", [&] {
        if (const auto* declared = accept_declared<Camera>(p)) {
            said.camera = *declared;
            copied = true;
        } else if (parse_camera_word(p, said))
            accept_comma(p);
        else
            unexpected(p, "camera",
                       {"location"_kw, "look_at"_kw, "right"_kw, "up"_kw, "direction"_kw, "sky"_kw,
                        "angle"_kw, "perspective"_kw, "orthographic"_kw, "translate"_kw, "rotate"_kw,
                        "scale"_kw});
    });
    if (copied) said.sized = true; // its size was settled where it was declared
    finish_camera(p, opener, said);
    return said.camera;
}

} // namespace pnr
