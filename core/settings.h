// SPDX-License-Identifier: GPL-3.0-or-later
// Every setting and its default, once. The parser and the command line fill these; the passes read them.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

// How the light of a scene is computed (design: "Which light a scene gets").
enum class Illumination {
    raytraced,     // as POV-Ray would: direct light, ambient terms, no photons
    caustics,      // the same plus a caustic map (`photons {}` alone)
    radiosity,     // the same with gathered light in place of ambient terms: `radiosity {}` in a .pov
    photon_mapped, // direct light by shadow rays, everything indirect from the photon map; ambient terms are
                   // 0
};

struct PhotonSettings {
    bool wanted = false;         // a `photons {}` block stands in global_settings
    std::optional<bool> global;  // `global on | off`; unset: decided by the scene
    bool count_given = false;    // the author said `count` or `spacing`
    std::int64_t count = 200000; // photons emitted in a pass, over all lights
    double spacing = 0;   // instead of count: mean distance of photons on the scene's surface; 0: not used
    int gather_min = 20;  // POV-Ray's word: where the radius holds fewer photons it is widened, twice at most
    int gather_max = 100; // the nearest so many are gathered
    double radius = 0;    // largest gather radius in scene units; 0: from the scene and the count
};

// POV-Ray's words of `radiosity` that our own gathering has a use for, with POV-Ray's defaults.
struct RadiositySettings {
    double brightness = 1;
    int recursion_limit = 2; // bounces
    double gray_threshold = 0; // how far colour bleeding is taken back: 1 makes gathered light grey
    int count = 35;            // rays that gather at one point (here: at least so many)
    double error_bound = 1.8;
    bool normal = false;       // gathered light follows perturbed normals
};

// How pixels of raytraced pictures are sampled: POV-Ray's method 1. A ray through the centre; where neighbours differ by
// more than `threshold` (sum over the channels of encoded values), also depth x depth rays of a grid.
struct GridSampling {
    double threshold = 0.3;
    int depth = 3;
    double jitter = 0;
    double gamma = 2.5;       // linear light v is compared as v^(1 / gamma), clipped at 1
    double value_gamma = 1;   // linear light of a value; 0: the sRGB curve
};

enum class Integrator { photons, path };
enum class View { clip, shoulder };

struct RenderSettings {
    int width = 0, height = 0; // pixels; 0: from the camera, width 512, height 512 |up| / |right| of the command line
    std::uint64_t seed = 1;
    int samples_min = 4;            // rays a pixel at first ...
    int samples_max = 16;           // ... and where neighbours differ by more than `contrast`
    double contrast = 0.04;         // relative difference that asks for more samples
    GridSampling grid;              // in their place where a picture is raytraced as POV-Ray would
    int gather_effort = 1;          // FieldSettings::effort
    bool sharp = true;              // indirect light is gathered anew where the field's records lie too far apart
    int max_trace_level = 10;       // specular chain length; POV-Ray scenes (`.pov`) get 5
    double adc_bailout = 1.0 / 255; // a chain of smaller weight than this is given up
    int shadow_samples = 32; // shadow rays to each area emitter, over a pixel's samples together at least
    Integrator integrator = Integrator::photons;
    View view = View::clip;
    double exposure = 0; // stops, for PNG alone
    bool prune = true;   // --no-prune: take the unpruned path everywhere
};

// ---- painting
// -------------------------------------------------------------------------------------------------

// -r and r^3. In space r is itself the biharmonic function [Carr et al. 2001], so the word `linear` means
// biharmonic too.
enum class RbfKernel { biharmonic, triharmonic };
enum class SeedDistance { straight, geodesic }; // geodesic: along the surface, on meshes
enum class FieldSource { seeds, curvature_min, curvature_max, along, around, light, gradient };
enum class Fill { nearest, random };

// One `seed { <position>, <direction> [weight w] }`, in scene space once the object's transforms are applied.
struct Seed {
    Vec3 position{0};
    Vec3 direction{1, 0, 0};
    double weight = 1;
    SourceRef said_at;
};

// One coat of strokes, `layer { length l  cell c  noise l, ab  edge e  opacity o  blur b  bare k [, plain] }`
// inside `ilic`. Coats are painted in the order of the text, each over the ones before.
struct PaintLayer {
    double length = 26;             // of the whole ILIC path, both sides
    double cell = 4.5;              // width of a noise cell
    double noise_lightness = 0.035; // standard deviations of the result, Oklab L ...
    double noise_chroma = 0.025;    // ... and a, b
    double edge = 40;               // 0: the paper's mean; 40: one cell wins the path
    double opacity = 1;             // of a stroke over the coats below
    double blur = 0;                // the strokes' colours are first blurred by this standard deviation
    double bare = 0;                // share of the surface that is left as the coats below have it ...
    double bare_plain =
        0; // ... and the share where the picture is plain, away from silhouettes and lightness edges
};

// All that `npr { ... }` can say, with the defaults of design.md section 3. Lengths are in pixels of a
// picture 512 high and scale with the height.
struct PaintStyle {
    std::vector<Seed> seeds;
    RbfKernel kernel = RbfKernel::biharmonic;
    SeedDistance distance = SeedDistance::straight;
    double smooth = 0;  // added to the RBF matrix' diagonal, relative to its mean off-diagonal entry
    int neighbours = 0; // 0: all seeds; n: the n nearest
    FieldSource field = FieldSource::seeds; // without seeds: curvature_min
    Vec3 field_vector{0, 1, 0};             // `along`: the vector; `around`: the axis
    Vec3 field_point{0};                    // `around`: a point of the axis
    double field_weight = 0;                // share of the field beside seeds in the blend; 0: one alone
    double radius = 5;                      // of the informative map's disc
    Fill fill = Fill::nearest;
    bool folds = false; // the disc does not reach over a fold of its object
    double length = 26;             // of the whole ILIC path, both sides
    double cell = 4.5;              // width of a noise cell
    double noise_lightness = 0.035; // standard deviations of the result, Oklab L ...
    double noise_chroma = 0.025; // ... and a, b; paper_mode: the first is that of each of the display's R, G,
                                 // B, uniform, before the convolution, and the second does nothing
    double edge = 40;               // 0: the paper's mean; 40: one cell wins the path
    std::vector<PaintLayer> layers; // `layer { ... }` items; empty: one coat of the five values above
    double size = 1;                // of all strokes: multiplies every coat's length, cell and blur
    // `tone { contrast c  saturation s  warm w }`, done to the colours before the painting: Oklab lightness
    // about the object's median, chroma, and how far lights go to yellow and shadows to blue.
    double contrast = 1, saturation = 1, warm = 0;
    double relief = 0;  // `relief r [, b]`: strokes lit as ridges of paint from the top left,
    double bristle = 0; // and the standard deviation in Oklab L of the brush's marks along the strokes
    std::optional<double> gaussian_first,
        gaussian_second;      // windows of the field's smoothing; unset: field_windows()
    double step = 0.5;        // of the path, in pixels
    double mix = 1;           // 0 photoreal .. 1 painted
    bool box_weights = false; // paper_mode: box instead of Hann
    bool vectors = false;     // paper_mode: blend plain vectors, not axes
    bool paper_mode = false;  // [LW10] to the letter
};

// `style WORD`: sets how paint is laid (length to edge above, layers, size, tone, relief, gaussian, step, the
// weights' shape) to the named style's and leaves seeds, rbf, field, radius, fill, mix, vectors and
// paper_mode alone. False, and nothing changed, for an unknown word.
//   ilic     one coat, the default; within paper_mode the paper's
//   oil      three coats, contrasts, relief, bristles: the fullest
//   impasto  two coats of broad strokes, thick: the strongest relief and bristles
//   pastel   two coats of short strokes with soft edges, the upper one thin
//   fur      two coats, long and thin, hardly varied in hue
//   wash     one coat: the paper's mean with restored noise, soft and wet
bool set_style(PaintStyle& style, std::string_view word);
std::vector<std::string> style_words();
// The field an object is painted along: what was said, or curvature_min where neither seeds nor a field were.
FieldSource painted_field(const PaintStyle& style);
// The two smoothing windows, in pixels at 512: as said, or 15, 7 along seeds and given axes, and 31, 15 along
// curvature.
Vec2 field_windows(const PaintStyle& style);

// The style that `paper_mode on` starts from.
PaintStyle paper_style();
// The style an npr object without any word gets; without seeds (a curvature field) the windows are wider.
PaintStyle default_style();

struct Settings {
    RenderSettings render;
    PhotonSettings photons;
    RadiositySettings radiosity;
};

} // namespace pnr
