// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas: POV-Ray 3.7 reference, "Normal", for what they look like; their numbers were measured against POV-Ray's pictures.
#include "core/normal_bumps.h"

#include "core/noise.h"

#include <algorithm>
#include <cmath>

namespace pnr {

namespace {

Vec3 bumps(const Vec3& p) { return noise_vector(p); }

Vec3 dents(const Vec3& p, int generator) {
    const double depth = noise(p, generator);
    return depth * depth * depth * noise_vector(p);
}

Vec3 wrinkles(const Vec3& p) {
    Vec3 sum(0);
    double scale = 1;
    for (int octave = 0; octave < 10; ++octave, scale *= 2) sum += glm::abs(noise_vector(p * scale)) / scale;
    return sum;
}

} // namespace

bool has_bump_vector(const Normal& normal) {
    const auto* plain = std::get_if<PlainPattern>(&normal.pattern.kind);
    if (!plain) return false;
    switch (plain->kind) {
    case PlainKind::bumps:
    case PlainKind::dents:
    case PlainKind::wrinkles:
        return true;
    default:
        return false;
    }
}

Vec3 bumped(const Normal& normal, const SurfacePoint& here, Vec3 n) {
    const auto* plain = std::get_if<PlainPattern>(&normal.pattern.kind);
    switch (plain->kind) {
    case PlainKind::dents:
        return n + normal.size * dents(here.point, normal.pattern.noise_generator);
    case PlainKind::wrinkles:
        return n + normal.size * wrinkles(here.point);
    default:
        return n + normal.size * bumps(here.point);
    }
}

} // namespace pnr
