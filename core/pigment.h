// SPDX-License-Identifier: GPL-3.0-or-later
// Colour that varies over a surface, as POV-Ray's `pigment` says it: a pattern and the colours it picks.
//
// To add a pattern: create its struct here, add it to `Pattern`, give its value in eval_pattern (pigment.cpp), read it in
// the parser's table of patterns, and write its line into grammar/pnr.ebnf.
#pragma once

#include "core/image.h"
#include "core/types.h"

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace pnr {

// A colour with POV-Ray's two kinds of transparency. filter: light that passes is tinted by rgb; transmit: it is not.
struct ColorFT {
    Color rgb{0};
    float filter = 0;
    float transmit = 0;
};

struct UniformPattern {};  // one colour: the first of the map
struct CheckerPattern {};  // unit cubes, colours 0 and 1
struct GradientPattern {   // value = fractional part of dot(point, axis / |axis|), as POV-Ray's gradient
    Vec3 axis{1, 0, 0};
};
enum class ImageMapType { planar = 0, spherical = 1, cylindrical = 2, torus = 5, uv = 100 };
struct ImagePattern { // colour from a picture; the map is not used
    std::string file;               // path, resolved and checked by the parser; read by build_world
    ImageMapType map_type = ImageMapType::planar;
    bool once = false;              // outside the unit square: transparent instead of tiled
    bool interpolate = true;        // bilinear
    bool as_stored = false;         // the file's 8-bit values are working values, as before POV-Ray 3.7
    SourceRef said_at;
    std::shared_ptr<const Image<glm::vec4>> image; // working values (Scene::assumed_gamma) and alpha; filled by build_world
};
using Pattern = std::variant<UniformPattern, CheckerPattern, GradientPattern, ImagePattern>;

struct ColorStop {
    double position = 0; // in [0, 1]
    ColorFT color;
};

struct Pigment {
    Pattern pattern;
    std::vector<ColorStop> map{{0, {}}}; // color_map, or the pattern's list of colours at positions 0, 1, 2 ...; never empty
    double frequency = 1, phase = 0;     // value -> fract(value * frequency + phase), for continuous patterns
    Transform transform;                 // pattern space -> scene space (build_world: -> world space)
};

// The colour at a point (in the space of pigment.transform's result). uv are the surface's own coordinates.
ColorFT eval_pigment(const Pigment& pigment, Vec3 point, Vec2 uv);

} // namespace pnr
