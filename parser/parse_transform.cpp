// SPDX-License-Identifier: GPL-3.0-or-later
// Transforms, and what they do to the things that were said before them.
#include "parser/blocks.h"

#include <stdexcept>

namespace pnr {

namespace {

Transform parse_scale(Parser& p, const Token& at) {
    Vec3 factors = parse_vector(p);
    for (int i = 0; i < 3; ++i) {
        if (factors[i] != 0) continue;
        warn(p, at, "`scale` by 0 is taken as 1");
        factors[i] = 1;
    }
    return scaling(factors);
}

Transform parse_matrix(Parser& p, const Token& at) {
    double rows[12];
    expect(p, '<', "to start the twelve numbers of `matrix`");
    for (double& number : rows) {
        number = parse_float(p);
        accept_comma(p);
    }
    expect(p, '>', "behind the twelve numbers of `matrix`");
    try {
        return matrix_transform(rows);
    } catch (const std::invalid_argument&) {
        fail(p, at, "this matrix is singular: it flattens space");
    }
}

} // namespace

Transform parse_transform(Parser& p) {
    if (const auto* declared = accept_declared<Transform>(p)) return *declared;
    Transform transform;
    block(p, "transform", [&] {
        if (const auto* declared = accept_declared<Transform>(p))
            transform = then(transform, *declared);
        else if (accept(p, "inverse"_kw))
            std::swap(transform.matrix, transform.inverse);
        else if (!accept_transform(p, transform))
            unexpected(p, "transform",
                       {"translate"_kw, "rotate"_kw, "scale"_kw, "matrix"_kw, "transform"_kw, "inverse"_kw});
    });
    return transform;
}

bool accept_transform(Parser& p, Transform& transform) {
    const Token word = peek(p);
    Transform said;
    switch (keyword_of(word)) {
    case "translate"_kw:
        next(p), said = translation(parse_vector(p));
        break;
    case "rotate"_kw:
        next(p), said = rotation(parse_vector(p));
        break;
    case "scale"_kw:
        next(p), said = parse_scale(p, word);
        break;
    case "matrix"_kw:
        next(p), said = parse_matrix(p, word);
        break;
    case "transform"_kw:
        next(p), said = parse_transform(p);
        break;
    default:
        return false;
    }
    accept_comma(p);
    transform = then(transform, said);
    return true;
}

void apply_transform(const Transform& by, Pigment& pigment) { transform_pigment(pigment, by); }

void apply_transform(const Transform& by, Texture& texture) { transform_texture(texture, by); }

void apply_transform(const Transform& by, PaintWord& word) {
    for (Seed& seed : word.style.seeds) {
        seed.position = transform_point(by.matrix, seed.position);
        seed.direction = transform_vector(by.matrix, seed.direction);
    }
    if (!word.own_axis) return;
    word.style.field_point = transform_point(by.matrix, word.style.field_point);
    word.style.field_vector = transform_vector(by.matrix, word.style.field_vector);
}

void apply_transform(const Transform& by, Object& object) {
    object.transform = then(object.transform, by);
    if (object.texture) apply_transform(by, *object.texture);
    if (object.interior_texture) apply_transform(by, *object.interior_texture);
    if (object.npr) apply_transform(by, *object.npr);
    for (auto* parts : {&object.children, &object.clips, &object.bounds})
        for (Object& part : *parts) apply_transform(by, part);
    for (LightSource& light : object.lights) apply_transform(by, light);
}

void apply_transform(const Transform& by, Camera& camera) {
    camera.location = transform_point(by.matrix, camera.location);
    camera.direction = transform_vector(by.matrix, camera.direction);
    camera.right = transform_vector(by.matrix, camera.right);
    camera.up = transform_vector(by.matrix, camera.up);
}

} // namespace pnr
