// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/noise.h"
#include "core/pattern_values.h"

namespace pnr {

namespace {

// The sources of ripples and waves: source i lies on the unit sphere, towards the noise vector at (i, 0, 0).
// The frequencies' generator is the lattice's, in a state found from the spectrum of POV-Ray's waves about
// the origin.
std::vector<WaveSource> make_wave_sources() {
    std::vector<WaveSource> sources;
    std::uint32_t state = 1586631681;
    for (int i = 0; i < most_wave_sources; ++i) {
        state = next_lattice_random(state);
        sources.push_back({glm::normalize(noise_vector({double(i), 0, 0})),
                           lattice_random_value(state) * (1 / 32767.0) + 0.01});
    }
    return sources;
}

double distance_to(const WaveSource& source, Vec3 p) {
    const double length = glm::length(p - source.center);
    return length == 0 ? 1 : length;
}

double ripples(const Pattern& pattern, Vec3 p) {
    double sum = 0;
    for (int i = 0; i < pattern.number_of_waves; ++i)
        sum += cycloid(distance_to(wave_sources()[static_cast<std::size_t>(i)], p) * pattern.frequency +
                       pattern.phase);
    return 0.5 * (1 + sum / pattern.number_of_waves);
}

double waves(const Pattern& pattern, Vec3 p) {
    double sum = 0;
    for (int i = 0; i < pattern.number_of_waves; ++i) {
        const WaveSource& source = wave_sources()[static_cast<std::size_t>(i)];
        sum += cycloid(distance_to(source, p) * pattern.frequency * source.frequency + pattern.phase) /
               source.frequency;
    }
    return 0.2 * (2.5 + sum / pattern.number_of_waves);
}

double wrinkles(Vec3 p, int generator) {
    const auto octave = [&](Vec3 q) {
        const double value = noise(q, generator);
        return generator == 1 ? value : std::clamp(2 * value - 0.5, 0.0, 1.0);
    };
    double sum = octave(p), scale = 2, weight = 0.5;
    for (int i = 1; i < 10; ++i, scale *= 2, weight *= 0.5) sum += weight * octave(p * scale);
    return sum / 2;
}

double granite(Vec3 p, int generator) {
    double sum = 0, scale = 1;
    for (int i = 0; i < 6; ++i, scale *= 2) {
        const double value = noise(p * (4 * scale), generator);
        const double away = generator == 1 ? 0.5 - value : 1 - 2 * value;
        sum += std::min(std::abs(away), 0.5) / scale;
    }
    return sum;
}

double marble(const Pattern& pattern, Vec3 p) {
    if (!pattern.turbulence) return p.x;
    return p.x + pattern.turbulence->amount.x * turbulence(p, *pattern.turbulence, pattern.noise_generator);
}

double wood(const Pattern& pattern, Vec3 p) {
    Vec2 q(p.x, p.y);
    if (pattern.turbulence) {
        const Vec3 moved = turbulence_vector(p, *pattern.turbulence);
        for (int i = 0; i < 2; ++i) q[i] += cycloid((p[i] + moved[i]) * pattern.turbulence->amount[i]);
    }
    return glm::length(q);
}

double leopard(Vec3 p) {
    const double mean = (std::sin(p.x) + std::sin(p.y) + std::sin(p.z)) / 3;
    return mean * mean;
}

double radial(Vec3 p) {
    if (std::abs(p.x) < 0.001 && std::abs(p.z) < 0.001) return 0.25;
    return 0.25 + (std::atan2(p.x, p.z) + pi) / (2 * pi);
}

double within(double distance) { return std::max(0.0, 1 - distance); }

} // namespace

const std::vector<WaveSource>& wave_sources() {
    static const std::vector<WaveSource> sources = make_wave_sources();
    return sources;
}

double value_of(const PlainPattern& kind, const Pattern& pattern, const SurfacePoint& at) {
    const Vec3 p = at.point;
    const int generator = pattern.noise_generator;
    switch (kind.kind) {
    case PlainKind::bozo:
    case PlainKind::bumps:
        return noise(p, generator);
    case PlainKind::dents: {
        const double value = noise(p, generator);
        return value * value * value;
    }
    case PlainKind::wrinkles:
        return wrinkles(p, generator);
    case PlainKind::granite:
        return granite(p, generator);
    case PlainKind::marble:
        return marble(pattern, p);
    case PlainKind::wood:
        return wood(pattern, p);
    case PlainKind::leopard:
        return leopard(p);
    case PlainKind::onion:
        return fraction(glm::length(p));
    case PlainKind::radial:
        return radial(p);
    case PlainKind::spherical:
        return within(glm::length(p));
    case PlainKind::cylindrical:
        return within(std::hypot(p.x, p.z));
    case PlainKind::planar:
        return within(std::abs(p.y));
    case PlainKind::boxed:
        return within(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
    case PlainKind::cells:
        return cells_value(p);
    case PlainKind::ripples:
        return ripples(pattern, p);
    case PlainKind::waves:
        return waves(pattern, p);
    }
    return 0;
}

double value_of(const AgatePattern& kind, const Pattern& pattern, const SurfacePoint& at) {
    const Turbulence words = pattern.turbulence.value_or(Turbulence{});
    const double moved = kind.turbulence * turbulence(at.point, words, pattern.noise_generator);
    const double value = 0.5 * (cycloid(1.3 * moved + 1.1 * at.point.z) + 1);
    return std::pow(std::clamp(value, 0.0, 1.0), 0.77);
}

double value_of(const SpiralPattern& kind, const Pattern& pattern, const SurfacePoint& at) {
    const Vec3 p = at.point;
    const double radius = std::hypot(p.x, p.y);
    double angle = radius > 0 ? std::atan2(p.x, -p.y) : 0; // from -y towards +x
    if (angle < 0) angle += 2 * pi;
    const double around = p.z + kind.arms * angle / (2 * pi);
    const double moved = pattern.turbulence ? pattern.turbulence->amount.x *
                                                  turbulence(p, *pattern.turbulence, pattern.noise_generator)
                                            : 0;
    if (!kind.second) return around + radius + moved;
    return triangle_wave(radius) + triangle_wave(around + radius + moved);
}

double value_of(const QuiltedPattern& kind, const SurfacePoint& at) {
    const Vec3 from_center = at.point - glm::floor(at.point) - Vec3(0.5);
    const double t = glm::length(from_center), s = 1 - t;
    const double cubic = 3 * t * s * s * kind.control0 + 3 * t * t * s * kind.control1 + t * t * t;
    const Vec3 a = glm::abs(from_center);
    return cubic * (a.x + a.y + a.z) * (2 / std::sqrt(3.0)) / 3;
}

} // namespace pnr
