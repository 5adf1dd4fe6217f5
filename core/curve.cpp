// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/curve.h"

#include "core/polynomial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pnr {

namespace {

std::size_t last(const CurvePiece& piece) { return static_cast<std::size_t>(piece.degree); }

// A coordinate less `offset` in Bernstein form, and its roots.
int coordinate_roots(const CurvePiece& piece, int axis, double offset, double* roots) {
    double b[4];
    for (std::size_t i = 0; i <= last(piece); ++i) b[i] = piece.points[i][axis] - offset;
    return bernstein_roots({b, last(piece) + 1}, roots);
}

// The piece from b to c, with neighbours a and d, of the splines through their points.
CurvePiece quadratic_piece(Vec2 a, Vec2 b, Vec2 c) { return make_piece(2, {b, b + 0.25 * (c - a), c}); }
CurvePiece cubic_piece(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    return make_piece(3, {b, b + (c - a) / 6.0, c - (d - b) / 6.0, c});
}

void add_piece(std::vector<CurvePiece>& pieces, const CurvePiece& piece) {
    if (piece.low != piece.high) pieces.push_back(piece);
}

void require(bool fine, const char* text) {
    if (!fine) throw std::invalid_argument(text);
}

bool same_place(Vec2 a, Vec2 b) {
    return glm::distance(a, b) <=
           1e-9 * std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
}

// How many points in front of and behind a curve only guide it.
std::size_t points_before(SplineKind kind) {
    return kind == SplineKind::quadratic || kind == SplineKind::cubic;
}
std::size_t points_behind(SplineKind kind) { return kind == SplineKind::cubic; }

// The curve through points[first] .. points[end - 1]; its guides stand around them.
void add_curve(std::vector<CurvePiece>& pieces, SplineKind kind, std::span<const Vec2> points,
               std::size_t first, std::size_t end) {
    if (kind == SplineKind::bezier) {
        for (std::size_t i = first; i + 3 < end; i += 4)
            add_piece(pieces, make_piece(3, {points[i], points[i + 1], points[i + 2], points[i + 3]}));
        return;
    }
    for (std::size_t i = first; i + 1 < end; ++i) {
        const Vec2 b = points[i], c = points[i + 1];
        if (kind == SplineKind::linear)
            add_piece(pieces, make_piece(1, {b, c}));
        else if (kind == SplineKind::quadratic)
            add_piece(pieces, quadratic_piece(points[i - 1], b, c));
        else
            add_piece(pieces, cubic_piece(points[i - 1], b, c, points[i + 2]));
    }
}

void check_count(SplineKind kind, std::size_t count) {
    switch (kind) {
    case SplineKind::linear:
        return require(count >= 2, "a linear spline needs at least 2 points");
    case SplineKind::quadratic:
        return require(count >= 3, "a quadratic spline needs at least 3 points");
    case SplineKind::cubic:
        return require(count >= 4, "a cubic spline needs at least 4 points");
    case SplineKind::bezier:
        return require(count >= 4 && count % 4 == 0,
                       "a Bezier spline needs four points for each of its pieces");
    }
}

} // namespace

CurvePiece make_piece(int degree, const std::array<Vec2, 4>& points) {
    CurvePiece piece{degree, points, points[0], points[0]};
    for (std::size_t i = 1; i <= last(piece); ++i) {
        piece.low = glm::min(piece.low, points[i]);
        piece.high = glm::max(piece.high, points[i]);
    }
    return piece;
}

Vec2 piece_point(const CurvePiece& piece, double s) {
    const double r = 1 - s;
    const auto& p = piece.points;
    if (piece.degree == 1) return r * p[0] + s * p[1];
    if (piece.degree == 2) return r * r * p[0] + 2 * r * s * p[1] + s * s * p[2];
    return r * r * r * p[0] + 3 * r * r * s * p[1] + 3 * r * s * s * p[2] + s * s * s * p[3];
}

Vec2 piece_tangent(const CurvePiece& piece, double s) {
    const double r = 1 - s;
    const auto& p = piece.points;
    Vec2 tangent = p[1] - p[0];
    if (piece.degree == 2) tangent = 2.0 * (r * (p[1] - p[0]) + s * (p[2] - p[1]));
    if (piece.degree == 3)
        tangent = 3.0 * (r * r * (p[1] - p[0]) + 2 * r * s * (p[2] - p[1]) + s * s * (p[3] - p[2]));
    if (tangent != Vec2(0)) return tangent;
    const double away = s < 0.5 ? s + 1e-4 : s - 1e-4;
    return (piece_point(piece, away) - piece_point(piece, s)) / (away - s);
}

std::vector<CurvePiece> open_curve(SplineKind kind, std::span<const Vec2> points) {
    check_count(kind, points.size());
    std::vector<CurvePiece> pieces;
    add_curve(pieces, kind, points, points_before(kind), points.size() - points_behind(kind));
    require(!pieces.empty(), "all points of the curve are the same");
    return pieces;
}

std::vector<CurvePiece> closed_curves(SplineKind kind, std::span<const Vec2> points, bool& is_closed) {
    check_count(kind, points.size());
    std::vector<Vec2> own(points.begin(), points.end());
    std::vector<CurvePiece> pieces;
    is_closed = true;
    const std::size_t step = kind == SplineKind::bezier ? 4 : 1;
    for (std::size_t at = 0; at + points_before(kind) + 1 < own.size();) {
        const std::size_t first = at + points_before(kind), stop = own.size() - points_behind(kind);
        std::size_t end = first + (step == 4 ? 3 : 1);
        while (end < stop && !same_place(own[end], own[first])) end += step;
        if (end < stop)
            own[end] = own[first];
        else {
            is_closed = false;
            end = stop - 1;
        }
        add_curve(pieces, kind, own, first, end + 1);
        if (!is_closed && end > first) add_piece(pieces, make_piece(1, {own[end], own[first]}));
        at = end + 1 + points_behind(kind);
    }
    require(!pieces.empty(), "all points of the curve are the same");
    return pieces;
}

bool curves_contain(std::span<const CurvePiece> pieces, Vec2 p) {
    bool inside = false;
    for (const CurvePiece& piece : pieces) {
        if (p.y < piece.low.y || p.y > piece.high.y || p.x > piece.high.x) continue;
        if (p.x < piece.low.x) { // all of it is to the right: only its ends count
            inside ^= (piece.points[0].y - p.y < 0) != (piece.points[last(piece)].y - p.y < 0);
            continue;
        }
        double roots[3];
        const int count = coordinate_roots(piece, 1, p.y, roots);
        for (int i = 0; i < count; ++i) inside ^= piece_point(piece, roots[i]).x > p.x;
    }
    return inside;
}

void orient_pieces(std::vector<CurvePiece>& pieces) {
    Vec2 low(infinity), high(-infinity);
    for (const CurvePiece& piece : pieces) low = glm::min(low, piece.low), high = glm::max(high, piece.high);
    const double size = std::max(high.x - low.x, high.y - low.y);
    for (CurvePiece& piece : pieces) {
        const Vec2 tangent = piece_tangent(piece, 0.43);
        const Vec2 normal = glm::normalize(Vec2(tangent.y, -tangent.x));
        const double step = std::min(1e-5 * size, 1e-2 * glm::distance(piece.low, piece.high));
        piece.turned = curves_contain(pieces, piece_point(piece, 0.43) + step * normal);
    }
}

int cross_line(const CurvePiece& piece, double a, double b, double c, double* roots) {
    double f[4];
    bool above = false, below = false;
    for (std::size_t i = 0; i <= last(piece); ++i) {
        f[i] = a * piece.points[i].x + b * piece.points[i].y + c;
        (f[i] < 0 ? below : above) = true;
    }
    if (!above || !below) return 0;
    if (piece.degree > 1) return bernstein_roots({f, last(piece) + 1}, roots);
    roots[0] = f[0] / (f[0] - f[1]);
    return 1;
}

} // namespace pnr
