// SPDX-License-Identifier: GPL-3.0-or-later
// Plane curves in pieces, each a Bezier curve of degree one to three: what lathes, prisms and letters are
// made of.
#pragma once

#include "core/types.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace pnr {

struct CurvePiece {
    int degree = 1;
    std::array<Vec2, 4> points{}; // degree + 1 of them
    Vec2 low{0}, high{0};         // a box that holds it
    bool turned = false;          // the normal (tangent.y, -tangent.x) points inwards
};

CurvePiece make_piece(int degree, const std::array<Vec2, 4>& points);
Vec2 piece_point(const CurvePiece& piece, double s);
Vec2 piece_tangent(const CurvePiece& piece,
                   double s); // the derivative; where it vanishes, the direction of the limit

// POV-Ray's splines for lathes and prisms [POV-Ray 3.7 manual 3.4.4.1.13]: quadratic ones have one point in
// front that is not met, cubic ones (Catmull and Rom's) one at either end; Bezier pieces take four points
// each.
enum class SplineKind { linear, quadratic, cubic, bezier };

// Pieces of one open curve. Throws std::invalid_argument, with what is wrong, if there are too few points, or
// not a multiple of four for Bezier.
std::vector<CurvePiece> open_curve(SplineKind kind, std::span<const Vec2> points);
// Pieces of closed curves, one after the other in `points`: a curve ends where it comes back to its first
// point. One that does not come back is closed by a straight piece, and `is_closed` is false then.
std::vector<CurvePiece> closed_curves(SplineKind kind, std::span<const Vec2> points, bool& is_closed);

// Whether p is inside closed curves, by the parity of what lies to its right.
bool curves_contain(std::span<const CurvePiece> pieces, Vec2 p);
// Finds `turned` of pieces whose curves are closed.
void orient_pieces(std::vector<CurvePiece>& pieces);

// Where the piece meets the line a x + b y + c = 0: parameters in `roots`, room for three; their number.
int cross_line(const CurvePiece& piece, double a, double b, double c, double* roots);

} // namespace pnr
