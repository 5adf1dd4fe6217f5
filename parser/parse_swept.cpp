// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that are made of curves: lathe, sor, prism, sphere_sweep, polygon, text.
#include "core/shape_swept.h"

#include "core/font.h"
#include "parser/blocks.h"
#include "parser/library.h"

#include <optional>
#include <stdexcept>

namespace pnr {

namespace {

constexpr int most_points = 1 << 22;

// What is wrong with the numbers is an error at `at`.
template <class F>
auto make(Parser& p, const Token& at, F maker) {
    try {
        return maker();
    } catch (const std::invalid_argument& wrong) {
        fail(p, at, wrong.what());
    }
}

// COUNT, then so many points.
template <class Point, class F>
std::vector<Point> parse_points(Parser& p, std::string_view what, F parse_point) {
    const Token at = peek(p);
    const int count = parse_int(p, 1, most_points, what);
    constexpr std::size_t curve = 256, segment = 96; // what is made of them
    charge(p, at, curve + static_cast<std::size_t>(count) * (sizeof(Point) + segment));
    std::vector<Point> points;
    points.reserve(static_cast<std::size_t>(count));
    accept_comma(p);
    for (int i = 0; i < count; ++i) {
        if (!at_expression(p))
            fail(p, peek(p),
                 std::string(what) + " says " + std::to_string(count) + " but there are " +
                     std::to_string(i));
        points.push_back(parse_point(p));
        accept_comma(p);
    }
    return points;
}

std::vector<Vec2> parse_curve_points(Parser& p) {
    return parse_points<Vec2>(p, "the number of points", parse_uv);
}

std::optional<SplineKind> accept_spline_kind(Parser& p) {
    if (accept(p, "linear_spline"_kw)) return SplineKind::linear;
    if (accept(p, "quadratic_spline"_kw)) return SplineKind::quadratic;
    if (accept(p, "cubic_spline"_kw)) return SplineKind::cubic;
    if (accept(p, "bezier_spline"_kw)) return SplineKind::bezier;
    return std::nullopt;
}

} // namespace

Shape parse_lathe(Parser& p) {
    const Token at = peek(p);
    const SplineKind kind = accept_spline_kind(p).value_or(SplineKind::linear);
    accept_comma(p);
    const std::vector<Vec2> points = parse_curve_points(p);
    return make(p, at, [&] { return make_lathe(kind, points); });
}

Shape parse_sor(Parser& p) {
    const Token at = peek(p);
    const std::vector<Vec2> points = parse_curve_points(p);
    return make(p, at, [&] { return make_sor(points); });
}

Shape parse_prism(Parser& p) {
    const Token at = peek(p);
    PrismWords words;
    for (;;) {
        if (accept(p, "linear_sweep"_kw))
            words.conic = false;
        else if (accept(p, "conic_sweep"_kw))
            words.conic = true;
        else if (const auto spline = accept_spline_kind(p))
            words.spline = *spline;
        else
            break;
        accept_comma(p);
    }
    words.from = parse_float(p);
    accept_comma(p);
    words.to = parse_float(p);
    accept_comma(p);
    const std::vector<Vec2> points = parse_curve_points(p);
    bool is_closed = true;
    const Shape prism = make(p, at, [&] { return make_prism(words, points, is_closed); });
    if (!is_closed)
        warn(p, at,
             "a curve of this prism does not come back to its first point: it is closed by a straight line");
    return prism;
}

Shape parse_sphere_sweep(Parser& p) {
    const Token at = peek(p);
    SweepKind kind = SweepKind::linear;
    if (accept(p, "b_spline"_kw))
        kind = SweepKind::b_spline;
    else if (accept(p, "cubic_spline"_kw))
        kind = SweepKind::cubic;
    else if (!accept(p, "linear_spline"_kw))
        unexpected(p, "sphere_sweep", {"linear_spline"_kw, "b_spline"_kw, "cubic_spline"_kw});
    accept_comma(p);
    const std::vector<SweepPoint> points =
        parse_points<SweepPoint>(p, "the number of spheres", [](Parser& parser) {
            SweepPoint point;
            point.center = parse_vector(parser);
            accept_comma(parser);
            point.radius = parse_float(parser);
            return point;
        });
    return make(p, at, [&] { return make_sphere_sweep(kind, points); });
}

Shape parse_polygon(Parser& p) {
    const Token at = peek(p);
    const std::vector<Vec3> points = parse_points<Vec3>(p, "the number of corners", parse_vector);
    return make(p, at, [&] { return make_polygon(points); });
}

// ---- text
// ----------------------------------------------------------------------------------------------------------

namespace {

// POV-Ray's built-in fonts by number; their files are the same as those of its include folder.
const char* internal_font(int number) {
    constexpr const char* names[] = {"timrom.ttf", "cyrvetic.ttf", "crystal.ttf", "povlogo.ttf"};
    return names[number - 1];
}

// The name as it stands, or with the ending of a font file, which POV-Ray adds where it is missing.
std::string find_font(Parser& p, const Token& at, const std::string& name) {
    if (!file_exists(p, name))
        for (const char* ending : {".ttf", ".ttc", ".otf"})
            if (file_exists(p, name + ending)) return resolve_file(p, at, name + ending);
    return resolve_file(p, at, name);
}

} // namespace

Shape parse_text(Parser& p) {
    Token at = peek(p);
    std::string font;
    if (accept(p, "internal"_kw)) {
        font = internal_font(parse_int(p, 1, 4, "the number of an internal font"));
    } else {
        if (!accept(p, "ttf"_kw)) unexpected(p, "text", {"ttf"_kw, "internal"_kw});
        at = peek(p);
        font = parse_string(p);
    }
    accept_comma(p);
    const std::string path = find_font(p, at, font);
    const Token said = peek(p);
    const std::string text = parse_string(p);
    accept_comma(p);
    const double thickness = parse_float(p);
    accept_comma(p);
    Vec3 offset(0);
    if (at_expression(p)) offset = parse_vector(p);
    constexpr std::size_t block = 1000, glyph = 200, work = 400; // work: in tokens, of a letter
    charge(p, said, block + text.size() * (sizeof(PlacedGlyph) + glyph));
    charge_work(p, said, static_cast<std::int64_t>(text.size() * work));
    try {
        return make_text(set_text(path, text, Vec2(offset)), thickness);
    } catch (const std::invalid_argument& wrong) {
        fail(p, at, wrong.what());
    }
}

} // namespace pnr
