// SPDX-License-Identifier: GPL-3.0-or-later
// The language's words. A word's number in this table is its Symbol, so that `"sphere"_kw` is a compile-time
// constant (a word that is not in the table does not compile) and a switch over words is a switch over
// integers.
//
// Reserved words are POV-Ray 3.7's: no identifier may bear their name. The words that painting, emitters and
// mesh files add are free words: a scene may declare an identifier of that name, which then is meant wherever
// an expression can stand, while the block that knows the word still finds it. British spellings (colour,
// colour_map ...) are turned into the American ones by the lexer.
#pragma once

#include "parser/token.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace pnr {

// A word of the table below, as a Symbol.
enum class Keyword : Symbol {};

// clang-format off
// Both lists are sorted: `"..."_kw` searches them by halves at compile time.
inline constexpr auto reserved_words = std::to_array<std::string_view>({
    "aa_level", "aa_threshold", "abs", "absorption", "accuracy", "acos", "acosh", "adaptive",
    "adc_bailout", "agate", "agate_turb", "albedo", "all", "all_intersections", "alpha", "altitude",
    "always_sample", "ambient", "ambient_light", "angle", "aoi", "aperture", "append", "arc_angle",
    "area_illumination", "area_light", "array", "asc", "ascii", "asin", "asinh", "assumed_gamma",
    "atan", "atan2", "atanh", "autostop", "average", "b_spline", "background", "bezier_spline",
    "bicubic_patch", "bitwise_and", "bitwise_or", "bitwise_xor", "black_hole", "blob", "blue",
    "blur_samples", "bokeh", "bounded_by", "box", "boxed", "bozo", "break", "brick", "brick_size",
    "brightness", "brilliance", "bump_map", "bump_size", "bumps", "camera", "case", "caustics", "ceil",
    "cells", "charset", "checker", "chr", "circular", "clipped_by", "clock", "clock_on", "collect",
    "color", "color_map", "component", "composite", "concat", "cone", "confidence", "conic_sweep",
    "conserve_energy", "contained_by", "control0", "control1", "coords", "cos", "cosh", "count",
    "crackle", "crand", "cube", "cubic", "cubic_spline", "cubic_wave", "cutaway_textures", "cylinder",
    "cylindrical", "datetime", "debug", "declare", "default", "defined", "degrees", "density",
    "density_file", "density_map", "dents", "deprecated", "df3", "difference", "diffuse",
    "dimension_size", "dimensions", "direction", "disc", "dispersion", "dispersion_samples", "dist_exp",
    "distance", "div", "double_illuminate", "eccentricity", "else", "elseif", "emission", "end",
    "error", "error_bound", "evaluate", "exp", "expand_thresholds", "exponent", "exr", "exterior",
    "extinction", "face_indices", "facets", "fade_color", "fade_distance", "fade_power", "falloff",
    "falloff_angle", "false", "fclose", "file_exists", "filter", "finish", "fisheye", "flatness",
    "flip", "floor", "focal_point", "fog", "fog_alt", "fog_offset", "fog_type", "fopen", "for", "form",
    "frequency", "fresnel", "function", "gamma", "gather", "gif", "global_lights", "global_settings",
    "gradient", "granite", "gray", "gray_threshold", "green", "hdr", "height_field", "hexagon",
    "hf_gray_16", "hierarchy", "hollow", "hypercomplex", "if", "ifdef", "iff", "ifndef", "image_map",
    "image_pattern", "importance", "include", "inside", "inside_vector", "int", "interior",
    "interior_texture", "internal", "interpolate", "intersection", "intervals", "inverse", "ior",
    "irid", "irid_wavelength", "isosurface", "jitter", "jpeg", "julia", "julia_fractal", "lambda",
    "lathe", "leopard", "light_group", "light_source", "linear_spline", "linear_sweep", "ln",
    "load_file", "local", "location", "log", "look_at", "looks_like", "low_error_factor", "macro",
    "magnet", "major_radius", "mandel", "map_type", "marble", "material", "material_map", "matrix",
    "max", "max_extent", "max_gradient", "max_intersections", "max_iteration", "max_sample",
    "max_trace", "max_trace_level", "maximum_reuse", "media", "media_attenuation", "media_interaction",
    "merge", "mesh", "mesh2", "mesh_camera", "metallic", "method", "metric", "min", "min_extent",
    "minimum_reuse", "mm_per_unit", "mod", "mortar", "natural_spline", "nearest_count", "no",
    "no_bump_scale", "no_image", "no_radiosity", "no_reflection", "no_shadow", "noise_generator",
    "normal", "normal_indices", "normal_map", "normal_vectors", "now", "number_of_sides",
    "number_of_tiles", "number_of_waves", "object", "octaves", "off", "offset", "omega", "omnimax",
    "on", "once", "onion", "open", "orient", "orientation", "orthographic", "ovus", "panoramic",
    "parallel", "parametric", "pass_through", "pattern", "perspective", "pgm", "phase", "phong",
    "phong_size", "photons", "pi", "pigment", "pigment_map", "pigment_pattern", "planar", "plane",
    "png", "point_at", "poly", "poly_wave", "polygon", "polynomial", "pot", "pow", "ppm", "precision",
    "precompute", "premultiplied", "pretrace_end", "pretrace_start", "prism", "prod",
    "projected_through", "pwr", "quadratic_spline", "quadric", "quartic", "quaternion", "quick_color",
    "quilted", "radial", "radians", "radiosity", "radius", "rainbow", "ramp_wave", "rand", "range",
    "ratio", "read", "reciprocal", "recursion_limit", "red", "reflection", "reflection_exponent",
    "refraction", "render", "repeat", "rgb", "rgbf", "rgbft", "rgbt", "right", "ripples", "rotate",
    "roughness", "samples", "save_file", "scale", "scallop_wave", "scattering", "seed", "select",
    "shadowless", "sin", "sine_wave", "sinh", "sint16be", "sint16le", "sint32be", "sint32le", "sint8",
    "size", "sky", "sky_sphere", "slice", "slope", "slope_map", "smooth", "smooth_triangle", "solid",
    "sor", "spacing", "specular", "sphere", "sphere_sweep", "spherical", "spiral1", "spiral2", "spline",
    "split_union", "spotlight", "spotted", "sqr", "sqrt", "square", "srgb", "srgbf", "srgbft", "srgbt",
    "statistics", "str", "strcmp", "strength", "strlen", "strlwr", "strupr", "sturm", "substr",
    "subsurface", "sum", "superellipsoid", "switch", "sys", "t", "tan", "tanh", "target", "text",
    "texture", "texture_list", "texture_map", "tga", "thickness", "threshold", "tiff", "tightness",
    "tile2", "tiles", "tiling", "tolerance", "toroidal", "torus", "trace", "transform", "translate",
    "translucency", "transmit", "triangle", "triangle_wave", "triangular", "true", "ttf", "turb_depth",
    "turbulence", "type", "u", "u_steps", "uint16be", "uint16le", "uint8", "ultra_wide_angle", "undef",
    "union", "up", "use_alpha", "use_color", "use_index", "utf8", "uv_indices", "uv_mapping",
    "uv_vectors", "v", "v_steps", "val", "variance", "vaxis_rotate", "vcross", "vdot", "version",
    "vertex_vectors", "vlength", "vnormalize", "vrotate", "vstr", "vturbulence", "warning", "warp",
    "water_level", "waves", "while", "width", "wood", "wrinkles", "write", "x", "xyz", "y", "yes", "z"
});

inline constexpr auto free_words = std::to_array<std::string_view>({
    "absorption_probability", "along", "around", "atan2d", "axis", "bare", "biharmonic", "blur", "cell",
    "clip", "clock_delta", "contrast", "curvature_max", "curvature_min", "edge", "emitter", "field", "file",
    "fill", "final_clock", "final_frame", "folds", "frame_number", "gaussian", "geodesic", "global", "h_angle",
    "height", "hemisphere", "ilic", "image_height", "image_width", "initial_clock", "initial_frame", "input_file_name",
    "interpolation", "kernel", "layer", "length", "light", "linear", "mix", "nearest", "neighbours", "noise",
    "npr", "opacity", "paper_mode", "power", "radiance", "ramp", "random", "rbf", "rectangle", "relief",
    "repair", "saturation", "seeds", "shoulder", "simplify", "specular_probability", "step", "straight",
    "style", "subdivide", "tau", "tone", "triharmonic", "v_angle", "view", "warm", "weight",
});
// clang-format on

inline constexpr Symbol keyword_count = reserved_words.size() + free_words.size();
static_assert(std::is_sorted(reserved_words.begin(), reserved_words.end()));
static_assert(std::is_sorted(free_words.begin(), free_words.end()));

constexpr std::string_view keyword_text(Keyword keyword) {
    const auto i = static_cast<std::size_t>(keyword);
    return i < reserved_words.size() ? reserved_words[i] : free_words[i - reserved_words.size()];
}
constexpr bool is_reserved(Symbol symbol) { return symbol < reserved_words.size(); }
constexpr bool is_keyword(Symbol symbol) { return symbol < keyword_count; }

// The number of a word; does not compile (not a constant expression) if the word is in neither list.
consteval Keyword operator""_kw(const char* text, std::size_t length) {
    const std::string_view word(text, length);
    const auto reserved = std::lower_bound(reserved_words.begin(), reserved_words.end(), word);
    if (reserved != reserved_words.end() && *reserved == word)
        return static_cast<Keyword>(reserved - reserved_words.begin());
    const auto free = std::lower_bound(free_words.begin(), free_words.end(), word);
    if (free == free_words.end() || *free != word) throw "this word is not in the keyword table";
    return static_cast<Keyword>(static_cast<std::size_t>(free - free_words.begin()) + reserved_words.size());
}

} // namespace pnr
