// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/orientation.h"

#include "core/closest_point.h"
#include "npr/field_sources.h"
#include "npr/geodesic_field.h"
#include "npr/rbf.h"

#include <fmt/format.h>

#include <atomic>

namespace pnr {

// The six numbers of T T^t in the order xx, yy, zz, xy, xz, yz; in paper_mode the three of T.
struct OrientationField {
    PaintStyle style;
    FieldSource source = FieldSource::seeds; // beside or instead of the seeds
    double share = 0;                        // of the source in the blend; 1: it alone
    std::vector<SnappedSeed> seeds;
    std::vector<double> values; // [seed][component]
    Rbf rbf;                    // over all seeds, when neighbours is 0
    std::shared_ptr<const GeodesicField> geodesic; // goes before the others where it has a value
    AxisSource axis_source;
};

namespace {

constexpr int tensor_size = 6;

int component_count(const PaintStyle& style) { return style.vectors ? 3 : tensor_size; }

Vec3 tangent_part(Vec3 v, Vec3 normal) { return v - normal * glm::dot(v, normal); }

// A tangent for where nothing better is known: the part of world y, or of x where y is the normal.
Vec3 any_tangent(Vec3 normal) {
    const Vec3 up = tangent_part({0, 1, 0}, normal);
    const Vec3 side = tangent_part({1, 0, 0}, normal);
    return glm::normalize(glm::length(up) > 0.1 ? up : side);
}

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void append_seed_value(OrientationField& field, const SnappedSeed& snapped, double weight) {
    const Vec3 t = snapped.axis;
    if (field.style.vectors) {
        for (int c = 0; c < 3; ++c) field.values.push_back(weight * t[c]);
        return;
    }
    for (const double v : {t.x * t.x, t.y * t.y, t.z * t.z, t.x * t.y, t.x * t.z, t.y * t.z})
        field.values.push_back(weight * v);
}

// Snaps the seeds to the object and lays their directions into the tangent plane: T = N x (N x D)
// [LW10 3.2.2], which is the tangent part of D turned round.
void snap_seeds(const World& world, int object, OrientationField& field, FieldReport& report) {
    const PaintStyle& style = field.style;
    if (style.seeds.empty()) return;
    const auto surface = index_surface(world, object);
    for (std::size_t i = 0; i < style.seeds.size(); ++i) {
        const Seed& seed = style.seeds[i];
        const auto note = [&](const std::string& text) {
            report.notes.push_back(fmt::format("{}:{}:{}: seed {}: {}", seed.said_at.file, seed.said_at.line,
                                               seed.said_at.column, i + 1, text));
        };
        const ClosestPoint closest = closest_point(*surface, seed.position);
        if (!std::isfinite(closest.distance)) {
            note("the object has no surface to snap to; left out");
            continue;
        }
        SnappedSeed snapped{closest.position, closest.normal, Vec3(0)};
        const double length = glm::length(seed.direction);
        const Vec3 direction = length > 0 && is_finite(seed.direction) ? seed.direction / length : Vec3(0);
        const Vec3 turned = glm::cross(snapped.normal, glm::cross(snapped.normal, direction));
        if (glm::length(turned) > 1e-6) {
            snapped.axis = glm::normalize(tangent_part(glm::normalize(turned), snapped.normal));
        } else {
            snapped.axis = any_tangent(snapped.normal);
            note(fmt::format("the direction is along the surface's normal; taken as <{:.3g}, {:.3g}, {:.3g}>",
                             snapped.axis.x, snapped.axis.y, snapped.axis.z));
        }
        const double weight = std::isfinite(seed.weight) && seed.weight > 0 ? seed.weight : 0;
        if (weight == 0) {
            note("its weight is not positive; left out");
            continue;
        }
        field.seeds.push_back(snapped);
        append_seed_value(field, snapped, weight);
    }
    report.seeds = static_cast<int>(field.seeds.size());
    constexpr std::size_t most_at_once = 1500; // the system of all seeds is dense
    constexpr int enough = 24;
    if (field.seeds.size() > most_at_once && field.style.neighbours == 0) {
        field.style.neighbours = enough;
        report.notes.push_back(fmt::format("more than {} seeds: each place takes the {} nearest", most_at_once, enough));
    }
}

std::vector<Vec3> seed_positions(const OrientationField& field) {
    std::vector<Vec3> points;
    for (const SnappedSeed& seed : field.seeds) points.push_back(seed.position);
    return points;
}

// The interpolated value at a point from some of the seeds, solved on the spot.
void eval_from_seeds(const OrientationField& field, std::span<const std::uint32_t> chosen, Vec3 position,
                     std::span<double> value) {
    const auto width = static_cast<std::size_t>(component_count(field.style));
    std::vector<Vec3> points;
    std::vector<double> values;
    for (const std::uint32_t i : chosen) {
        points.push_back(field.seeds[i].position);
        values.insert(values.end(), field.values.begin() + static_cast<std::ptrdiff_t>(i * width),
                      field.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
    }
    const Rbf rbf =
        solve_rbf(points, values, static_cast<int>(width), field.style.kernel, field.style.smooth);
    eval_rbf(rbf, position, value);
}

std::vector<std::uint32_t> nearest_seeds(const OrientationField& field, Vec3 position, std::size_t count) {
    std::vector<std::pair<double, std::uint32_t>> by_distance;
    for (std::uint32_t i = 0; i < field.seeds.size(); ++i)
        by_distance.emplace_back(glm::distance(field.seeds[i].position, position), i);
    count = std::min(count, by_distance.size());
    std::partial_sort(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(count),
                      by_distance.end());
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(by_distance[i].second);
    return chosen;
}

// An axis in the tangent plane as (cos 2t, sin 2t) times its strength, t against frame.x.
Vec2 axis_in_plane(const Frame& frame, Vec3 axis) {
    const double x = glm::dot(axis, frame.x), y = glm::dot(axis, frame.y);
    return {x * x - y * y, 2 * x * y};
}

// The tensor's part in the tangent plane; its major axis as a doubled angle, as long as the difference of the
// eigenvalues.
Vec2 tensor_in_plane(const Frame& frame, std::span<const double> m) {
    const auto form = [&](Vec3 a, Vec3 b) {
        return m[0] * a.x * b.x + m[1] * a.y * b.y + m[2] * a.z * b.z + m[3] * (a.x * b.y + a.y * b.x) +
               m[4] * (a.x * b.z + a.z * b.x) + m[5] * (a.y * b.z + a.z * b.y);
    };
    return {form(frame.x, frame.x) - form(frame.y, frame.y), 2 * form(frame.x, frame.y)};
}

Vec2 doubled(const Frame& frame, std::span<const double> value, bool vectors) {
    if (!vectors) return tensor_in_plane(frame, value);
    return axis_in_plane(frame, {value[0], value[1], value[2]});
}

Vec2 unit_or_zero(Vec2 v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : Vec2(0);
}

// Below this share of a seed's strength the interpolated axis says nothing.
constexpr double vanishing = 1e-9;

Vec3 axis_from_doubled(const Frame& frame, Vec3 normal, Vec2 axis) {
    if (!(glm::length(axis) > vanishing)) return any_tangent(normal);
    const double angle = 0.5 * std::atan2(axis.y, axis.x);
    return glm::normalize(tangent_part(frame.x * std::cos(angle) + frame.y * std::sin(angle), normal));
}

Vec3 blend(const OrientationField& field, Vec3 position, Vec3 normal, std::span<const double> from_seeds) {
    const Frame frame = make_frame(normal);
    Vec2 seeds(0), other(0);
    if (!from_seeds.empty()) seeds = doubled(frame, from_seeds, field.style.vectors);
    if (field.share > 0)
        other = unit_or_zero(axis_in_plane(frame, eval_axis_source(field.axis_source, position, normal)));
    if (field.share >= 1 || from_seeds.empty()) return axis_from_doubled(frame, normal, other);
    if (field.share > 0) seeds = unit_or_zero(seeds) * (1 - field.share) + other * field.share;
    const Vec3 axis = axis_from_doubled(frame, normal, seeds);
    // Plain vectors keep the sign that the seeds gave them: the picture's smoothing counts on it.
    if (field.style.vectors && glm::dot(axis, Vec3(from_seeds[0], from_seeds[1], from_seeds[2])) < 0)
        return -axis;
    return axis;
}

void measure_residual(const OrientationField& field, FieldReport& report) {
    if (field.share > 0) return;
    for (const SnappedSeed& seed : field.seeds) {
        const Vec3 axis = eval_orientation(field, seed.position, seed.normal);
        const double sine = glm::length(glm::cross(axis, seed.axis));
        report.residual = std::max(report.residual, std::asin(std::min(1.0, sine)));
    }
}

void add_geodesic(const World& world, int object, OrientationField& field, FieldReport& report) {
    field.geodesic = make_geodesic_field(world, object, seed_positions(field), field.values,
                                         component_count(field.style), field.style.smooth);
    if (!field.geodesic)
        report.notes.push_back(
            "rbf: `distance geodesic` goes along meshes alone, and this is none: the seeds' distances are straight");
}

std::shared_ptr<OrientationField> make_field(const World& world, int object, FieldReport& report) {
    auto field = std::make_shared<OrientationField>();
    field->style = world.objects[static_cast<std::size_t>(object)].paint;
    report.object = object;
    snap_seeds(world, object, *field, report);
    field->source = painted_field(field->style);
    if (field->seeds.empty() && field->source == FieldSource::seeds)
        field->source = FieldSource::curvature_min;
    if (field->source != FieldSource::seeds) {
        const double weight = std::clamp(field->style.field_weight, 0.0, 1.0);
        field->share = field->seeds.empty() || weight == 0 ? 1 : weight;
        field->axis_source = make_axis_source(world, object, field->source, field->style);
    }
    if (field->share < 1 && !field->seeds.empty() && field->style.neighbours == 0) {
        field->rbf = solve_rbf(seed_positions(*field), field->values, component_count(field->style),
                               field->style.kernel, field->style.smooth);
        report.condition = field->rbf.condition;
    }
    if (field->share < 1 && !field->seeds.empty() && field->style.distance == SeedDistance::geodesic)
        add_geodesic(world, object, *field, report);
    measure_residual(*field, report);
    if (report.residual > 1e-3 && field->style.smooth == 0)
        report.notes.push_back(
            fmt::format("seeds at the same place disagree: the field misses one by {:.3g} degrees",
                        report.residual * 180 / pi));
    return field;
}

} // namespace

OrientationFields make_orientation_fields(const World& world) {
    OrientationFields fields;
    fields.fields.resize(world.objects.size());
    for (std::size_t object = 0; object < world.objects.size(); ++object) {
        if (!world.objects[object].npr) continue;
        FieldReport report;
        fields.fields[object] = make_field(world, static_cast<int>(object), report);
        fields.reports.push_back(std::move(report));
    }
    return fields;
}

const std::vector<SnappedSeed>& snapped_seeds(const OrientationField& field) { return field.seeds; }

Vec3 eval_orientation(const OrientationField& field, Vec3 position, Vec3 normal) {
    std::array<double, tensor_size> storage{};
    const std::span<double> value(storage.data(), static_cast<std::size_t>(component_count(field.style)));
    if (field.seeds.empty() || field.share >= 1) return blend(field, position, normal, {});
    if (field.geodesic && eval_geodesic_field(*field.geodesic, position, value))
        return blend(field, position, normal, value);
    if (field.style.neighbours > 0)
        eval_from_seeds(field,
                        nearest_seeds(field, position, static_cast<std::size_t>(field.style.neighbours)),
                        position, value);
    else
        eval_rbf(field.rbf, position, value);
    return blend(field, position, normal, value);
}

namespace {

// ---- the paper's local rule
// ---------------------------------------------------------------------------------------

// Photons of one object with a tree over them, and for each seed the photon nearest to it: the "seed photons"
// of [LW10].
struct LocalRule {
    KdTree tree;
    std::vector<Vec3> seed_photons;
};

constexpr std::size_t smallest_q = 25; // [LW10 3.2.2]: Q = 20..30

LocalRule make_local_rule(const PhotonMap& map, const OrientationField& field, int object) {
    std::vector<Vec3f> points;
    for (const Photon& photon : map.photons)
        if (photon.npr() && photon.object() == object) points.push_back(photon.position);
    LocalRule rule;
    rule.tree = build_kdtree(points);
    std::vector<Neighbour> found;
    for (const SnappedSeed& seed : field.seeds) {
        find_nearest(rule.tree, Vec3f(seed.position), 1, std::numeric_limits<float>::infinity(), found);
        rule.seed_photons.push_back(found.empty() ? seed.position : Vec3(points[found.front().index]));
    }
    return rule;
}

// The seeds among the Q nearest photons, Q = 25 doubled until there are two. A seed is among the Q nearest
// when at most Q photons lie within its distance, so ranks are counted instead of drawing ever longer lists.
std::vector<std::uint32_t> local_seeds(const LocalRule& rule, Vec3 position, std::vector<Neighbour>& found) {
    std::vector<std::pair<float, std::uint32_t>> by_distance;
    for (std::uint32_t i = 0; i < rule.seed_photons.size(); ++i)
        by_distance.emplace_back(glm::distance(Vec3f(rule.seed_photons[i]), Vec3f(position)), i);
    std::sort(by_distance.begin(), by_distance.end());
    const auto rank = [&](std::size_t k) {
        find_within(rule.tree, Vec3f(position), by_distance[k].first, found);
        return found.size();
    };
    std::vector<std::uint32_t> chosen;
    const std::size_t needed = std::min<std::size_t>(2, by_distance.size());
    std::size_t q = smallest_q;
    for (std::size_t k = 0; k < by_distance.size(); ++k) {
        const std::size_t r = rank(k);
        if (k < needed)
            while (q < r) q *= 2;
        else if (r > q)
            break;
        chosen.push_back(by_distance[k].second);
    }
    return chosen;
}

} // namespace

std::vector<Vec3f> orient_photons(const World& world, const PhotonMap& map, const OrientationFields& fields,
                                  const Progress& progress) {
    std::vector<Vec3f> oriented(map.photons.size(), Vec3f(0));
    std::vector<std::unique_ptr<LocalRule>> local(fields.fields.size());
    for (std::size_t object = 0; object < fields.fields.size(); ++object) {
        const auto& field = fields.fields[object];
        if (field && world.objects[object].paint.paper_mode && field->seeds.size() >= 2 && !field->geodesic)
            local[object] =
                std::make_unique<LocalRule>(make_local_rule(map, *field, static_cast<int>(object)));
    }
    const auto count = static_cast<std::int64_t>(map.normals.size());
    std::atomic<std::int64_t> done{0};
    parallel_for(count, 2048, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        std::vector<Neighbour> found;
        std::array<double, tensor_size> storage{};
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const Photon& photon = map.photons[i];
            if (!photon.npr()) continue;
            const auto object = static_cast<std::size_t>(photon.object());
            if (object >= fields.fields.size() || !fields.fields[object]) continue;
            const OrientationField& field = *fields.fields[object];
            const Vec3 normal = glm::normalize(Vec3(map.normals[i])), position(photon.position);
            if (local[object] && field.share < 1) {
                const std::span<double> value(storage.data(),
                                              static_cast<std::size_t>(component_count(field.style)));
                eval_from_seeds(field, local_seeds(*local[object], position, found), position, value);
                oriented[i] = Vec3f(blend(field, position, normal, value));
            } else {
                oriented[i] = Vec3f(eval_orientation(field, position, normal));
            }
        }
        const std::int64_t now = done += end - begin;
        if (progress && !progress(now, count)) throw Interrupted{};
    });
    return oriented;
}

} // namespace pnr
