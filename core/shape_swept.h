// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that are swept: curves about an axis (lathe, sor) or along one (prism, text), a ball along a curve
// (sphere_sweep); and polygons.
#pragma once

#include "core/curve.h"
#include "core/shape_hits.h"

#include <memory>
#include <span>
#include <vector>

namespace pnr {

// Each of the makers takes finite numbers, and throws std::invalid_argument with what is wrong with them.

// Points are (distance from the axis, height).
Shape make_lathe(SplineKind kind, std::span<const Vec2> points);
// The square of the distance is a cubic in the height between two points, with slopes from the neighbours'
// [POV-Ray 3.7 manual 3.4.4.1.16]; the first and last points only give slopes. Heights must grow; at least
// four points.
Shape make_sor(std::span<const Vec2> points);

struct PrismWords {
    SplineKind spline = SplineKind::linear;
    bool conic = false; // the curve stands at y = 1 and grows with y
    double from = 0, to = 1;
};
// Points are (x, z). `is_closed` tells whether all curves came back to their starts.
Shape make_prism(const PrismWords& words, std::span<const Vec2> points, bool& is_closed);

enum class SweepKind { linear, b_spline, cubic };
struct SweepPoint {
    Vec3 center{0};
    double radius = 1;
};
Shape make_sphere_sweep(SweepKind kind, std::span<const SweepPoint> points);

// Corners in a plane; a sub-polygon ends where it comes back to its first corner. What lies in an even number
// of them is a hole.
Shape make_polygon(std::span<const Vec3> points);

// The outline of a letter, and the place of its origin on the line.
struct PlacedGlyph {
    std::shared_ptr<const std::vector<CurvePiece>> outline;
    Vec2 origin{0};
};
Shape make_text(std::span<const PlacedGlyph> glyphs, double thickness);

// As in shape_algebraic.h.
Bounds bounds_of(const Lathe& s);
Bounds bounds_of(const Sor& s);
Bounds bounds_of(const Prism& s);
Bounds bounds_of(const SphereSweep& s);
Bounds bounds_of(const Polygon& s);
Bounds bounds_of(const Text& s);
void intersect(const Lathe& s, const Ray& ray, HitList& hits);
void intersect(const Sor& s, const Ray& ray, HitList& hits);
void intersect(const Prism& s, const Ray& ray, HitList& hits);
void intersect(const SphereSweep& s, const Ray& ray, HitList& hits);
void intersect(const Polygon& s, const Ray& ray, HitList& hits);
void intersect(const Text& s, const Ray& ray, HitList& hits);
bool is_inside(const Lathe& s, Vec3 p);
bool is_inside(const Sor& s, Vec3 p);
bool is_inside(const Prism& s, Vec3 p);
bool is_inside(const SphereSweep& s, Vec3 p);
bool is_inside(const Polygon& s, Vec3 p); // never
bool is_inside(const Text& s, Vec3 p);

} // namespace pnr
