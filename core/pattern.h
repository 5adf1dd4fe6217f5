// SPDX-License-Identifier: GPL-3.0-or-later
// A value that varies over a surface or through space, as POV-Ray's patterns say it: what pigments, normals,
// textures, densities and functions pick from their maps by.
//
// To add a pattern: create its struct here, add it to `PatternKind`, give its value in one of the
// pattern_*.cpp, read it in parser/parse_pattern.cpp, and write its line into grammar/pnr.ebnf.
#pragma once

#include "core/boxed.h"
#include "core/image.h"
#include "core/scalar_field.h"
#include "core/types.h"
#include "core/warp.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pnr {

struct Pigment;     // pigment.h
struct DensityGrid; // density_grid.h

// What a pattern is asked about. In the same space as Pattern::transform's result (scene space in the parser,
// world space in a World).
struct SurfacePoint {
    Vec3 point{0};
    Vec2 uv{0};               // the surface's own coordinates
    Vec3 normal{0, 1, 0};     // unit; `slope` and `aoi` look at it
    Vec3 direction{0, 0, 1};  // unit, of the ray that came here
    double tolerance = 1e-10; // how far rounding may have moved the point; to_pattern_space sets it
};

// ---- kinds
// -----------------------------------------------------------------------------------------------------

struct UniformPattern {}; // one entry: the first of the map
struct AveragePattern {}; // all entries, the positions are their weights
struct GradientPattern {  // dot(point, axis / |axis|)
    Vec3 axis{1, 0, 0};
};
// Patterns that have no words of their own.
enum class PlainKind {
    bozo,
    bumps,
    dents,
    wrinkles,
    granite,
    marble,
    wood,
    leopard,
    onion,
    radial,
    spherical,
    cylindrical,
    planar,
    boxed,
    cells,
    ripples,
    waves,
};
struct PlainPattern {
    PlainKind kind = PlainKind::bozo;
};
struct AgatePattern {
    double turbulence = 1; // agate_turb
};
struct SpiralPattern {
    double arms = 1;
    bool second = false; // spiral2
};
struct QuiltedPattern {
    double control0 = 1, control1 = 1;
};
struct CracklePattern {
    Vec3 form{-1, 1, 0};
    double metric = 2;
    double offset = 0;
    bool solid = false;
};
struct FacetsPattern {           // moves normals; as a value it is 0
    double coords = 0, size = 0; // one of the two is said
};
enum class FractalKind { mandel, julia, magnet1_mandel, magnet2_mandel, magnet1_julia, magnet2_julia };
struct FractalPattern {
    FractalKind kind = FractalKind::mandel;
    int iterations = 10;
    int exponent = 2;
    Vec2 c{0};                                // of the Julia sets
    int exterior_type = 1, interior_type = 0; // how points outside and inside are valued
    double exterior_factor = 1, interior_factor = 1;
};
struct SlopePattern {
    Vec3 direction{0, 1, 0};
    bool toward_point = false;                  // direction is a point to look at (`point_at`)
    Vec3 altitude{0};                           // zero: slope alone counts; else the mean of both
    double low_slope = 0, high_slope = 0;       // range stretched to 0..1; both 0: as it is
    double low_altitude = 0, high_altitude = 0; // likewise
};
struct AoiPattern {}; // angle between normal and ray
// Lists: the value is the entry's number.
struct CheckerPattern {}; // unit cubes
struct HexagonPattern {};
struct CubicPattern {};
struct SquarePattern {};
struct TriangularPattern {};
struct BrickPattern { // entry 0 is mortar
    Vec3 size{8, 3, 4.5};
    double mortar = 0.5;
};
struct ObjectPattern {                // entry 1 inside
    std::function<bool(Vec3)> inside; // in pattern space; safe to call from many threads
};
struct TilingPattern { // a value for each tile of the kind
    int type = 1;
};

enum class ImageMapType { planar = 0, spherical = 1, cylindrical = 2, torus = 5 };
enum class Interpolation { none = 0, bilinear = 2, bicubic = 3, distance = 4 };
// A picture: in a pigment (image_map) it gives the colour and the map is not used; elsewhere (image_pattern)
// the value is its brightness, or its alpha.
struct ImagePattern {
    std::string
        file; // path, resolved and checked by the parser; read by prepare_pattern. Empty: made by a function
    ImageMapType map_type = ImageMapType::planar;
    bool once = false; // outside the unit square: transparent (value 0) instead of tiled
    Interpolation interpolation = Interpolation::bilinear;
    bool as_stored = false;         // the file's 8-bit values are working values, as before POV-Ray 3.7
    double file_gamma = 0;          // of the file's values; 0: what the file says
    float filter = 0, transmit = 0; // `filter all`, `transmit all`
    bool is_map = true;             // image_map
    bool use_color = false;         // image_pattern: brightness even where the picture has an alpha
    SourceRef said_at;
    std::shared_ptr<const Image<glm::vec4>> image; // working values (Scene::assumed_gamma) and alpha
};
struct DensityFilePattern {
    std::string file;    // df3; resolved by the parser, read by build_world
    int interpolate = 0; // 0 nearest, 1 trilinear, 2 tricubic
    SourceRef said_at;
    std::shared_ptr<const DensityGrid> grid;
};
struct PigmentPattern { // the brightness of a pigment
    std::shared_ptr<const Pigment> pigment;
};
struct FunctionPattern {
    ScalarField value;
};

using PatternKind = std::variant<UniformPattern, AveragePattern, GradientPattern, PlainPattern, AgatePattern,
                                 SpiralPattern, QuiltedPattern, CracklePattern, FacetsPattern, FractalPattern,
                                 SlopePattern, AoiPattern, CheckerPattern, HexagonPattern, CubicPattern,
                                 SquarePattern, TriangularPattern, TilingPattern, BrickPattern, ObjectPattern,
                                 ImagePattern, DensityFilePattern, PigmentPattern, FunctionPattern>;

enum class Wave { ramp, triangle, sine, scallop, cubic, poly };

// Build with set_kind, which sets the wave that belongs to the kind.
struct Pattern {
    PatternKind kind;
    Wave wave = Wave::ramp;
    double exponent = 1;                  // of Wave::poly
    double frequency = 1, phase = 0;      // value -> fract(value * frequency + phase), then the wave
    int noise_generator = 0;              // 1, 2, 3; 0: the scene's (filled by prepare_pattern)
    int number_of_waves = 0;              // of ripples and waves; 0: the scene's (likewise)
    bool uv_mapping = false;              // the point is <u, v, 0>, and `transform` maps from there
    Boxed<Turbulence> turbulence;        // said outside a warp
    std::vector<Warp> warps; // in the order of the text; those after a transform come behind a TransformWarp
    Seldom<Transform> transform; // warped space -> scene space (build_world: -> world space)
};

void set_kind(Pattern& pattern, PatternKind kind);
// A warp said behind everything said so far.
void add_warp(Pattern& pattern, Warp warp);

// How many entries a list pattern picks from (checker: 2); 0 for patterns that pick from a map by a
// continuous value.
int list_size(const Pattern& pattern);
inline bool is_list_pattern(const Pattern& pattern) { return list_size(pattern) > 0; }

// The value for a map, in [0, 1], with wave, frequency and phase; of a list pattern the number of the chosen
// entry. 0 for uniform and average. Never NaN.
double eval_pattern(const Pattern& pattern, const SurfacePoint& at);
// The same in two steps: to the pattern's own space, with warps and turbulence (where nested pigments and
// textures look too), then the value there.
SurfacePoint to_pattern_space(const Pattern& pattern, const SurfacePoint& at);
double eval_pattern_here(const Pattern& pattern, const SurfacePoint& warped);

// ---- maps
// ------------------------------------------------------------------------------------------------------

template <class T>
struct BlendEntry {
    double position = 0;
    T value;
};
// Sorted by position. ColorStop (pigment.h) is an entry for look_up too.
template <class T>
using BlendMap = std::vector<BlendEntry<T>>;

// Between which entries a value lies; `weight` is that of `high`.
struct BlendSpot {
    std::size_t low = 0, high = 0;
    double weight = 0;
};

// Linear between stops, constant beyond the first and the last; where two stops share a position the earlier
// one counts there. `map` is not empty. With `list` the value is an entry's number.
template <class Map>
BlendSpot look_up(const Map& map, double value, bool list = false) {
    const std::size_t last = map.size() - 1;
    if (list) {
        const std::size_t entry = value > 0 ? std::min(static_cast<std::size_t>(value), last) : 0;
        return {entry, entry, 0};
    }
    std::size_t next = 0;
    while (next <= last && map[next].position < value) ++next;
    if (next == 0) return {0, 0, 0};
    if (next > last) return {last, last, 0};
    const double width = map[next].position - map[next - 1].position;
    if (!(width > 0)) return {next, next, 0};
    return {next - 1, next, (value - map[next - 1].position) / width};
}

} // namespace pnr
