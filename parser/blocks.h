// SPDX-License-Identifier: GPL-3.0-or-later
// The scene's blocks. Functions return by value what was said; transforms inside a block are applied to what
// stands before them. Where a function reads a block, its word (`pigment`, `camera` ...) has been taken and
// `{` is next.
#pragma once

#include "parser/parser.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace pnr {

// A scene file: items until the end of input, into p.scene and p.settings. Errors are recorded in the
// diagnostics.
void parse_scene(Parser& p);

// If the next token starts a block that can be declared (object, texture, pigment, finish, interior,
// light_source, camera, transform, npr ...), parses it. Called by parse_value for #declare.
std::optional<DeclaredBlock> parse_declared_block(Parser& p);
// Warnings for what the scene's own file declares and names nowhere else, in included files neither.
void warn_unused(Parser& p);
// The block of `#default { ... }`, behind its `{` and up to its `}`.
void parse_default_block(Parser& p);

// ---- objects
// --------------------------------------------------------------------------------------------------

// The whole statement with its word; nothing if no object statement stands here. One that we know and lack
// comes back without shape and children, after a warning.
std::optional<Object> parse_object(Parser& p);
// One item that any object takes behind its own: texture, transforms, npr, flags. False if none stands here.
bool parse_object_modifier(Parser& p, Object& object);
// A shape's own items, up to the first modifier or `}`; parse_shapes.cpp, parse_mesh.cpp, parse_field_shapes.cpp,
// parse_algebraic.cpp and parse_swept.cpp.
Shape parse_sphere(Parser& p);
Shape parse_box(Parser& p);
Shape parse_plane(Parser& p);
Shape parse_cylinder(Parser& p);
Shape parse_cone(Parser& p);
Shape parse_torus(Parser& p);
Shape parse_disc(Parser& p);
Shape parse_triangle(Parser& p);
Shape parse_smooth_triangle(Parser& p);
Shape parse_mesh(Parser& p);
Shape parse_mesh2(Parser& p);
Shape parse_bicubic_patch(Parser& p);
Shape parse_isosurface(Parser& p);
Shape parse_blob(Parser& p);
Shape parse_height_field(Parser& p);
Shape parse_julia_fractal(Parser& p);
Shape parse_parametric(Parser& p);
Shape parse_quadric(Parser& p);
Shape parse_cubic(Parser& p);
Shape parse_quartic(Parser& p);
Shape parse_poly(Parser& p);
Shape parse_polynomial(Parser& p);
Shape parse_superellipsoid(Parser& p);
Shape parse_ovus(Parser& p);
Shape parse_lathe(Parser& p);
Shape parse_sor(Parser& p);
Shape parse_prism(Parser& p);
Shape parse_sphere_sweep(Parser& p);
Shape parse_polygon(Parser& p);
Shape parse_text(Parser& p);

// ---- textures
// -------------------------------------------------------------------------------------------------

Texture parse_texture(Parser& p, const Texture& start);
void map_by_uv(Texture& texture); // what `uv_mapping` makes of a texture: later transforms leave it alone
void parse_texture_item(Parser& p, Texture& texture); // one item of the block; at least one token is taken
BlendMap<Texture> parse_texture_map(Parser& p);
// Lays a texture over what is there; replaces it if not `layered`, or where one of them can't be layered.
void add_layer(Parser& p, Texture& below, const Texture& texture, bool layered);
Normal parse_normal(Parser& p, const Normal& start);
BlendMap<Normal> parse_normal_map(Parser& p);
SlopeMap parse_slope_map(Parser& p);
Pigment parse_pigment(Parser& p, const Pigment& start);
void parse_pigment_item(Parser& p, Pigment& pigment); // one item of the block; at least one token is taken
Finish parse_finish(Parser& p, const Finish& start);
Interior parse_interior(Parser& p, const Interior& start);
SaidMaterial parse_material(Parser& p);
ColorMap parse_color_map(Parser& p);
std::vector<ColorStop> default_map(const Token& word); // what a pattern's word shows without a map
BlendMap<Pigment> parse_pigment_map(Parser& p);
ImagePattern parse_image_map(Parser& p, double* bump_size = nullptr); // `bump_size` may stand there if not null
bool skip_pattern(Parser& p); // one pattern or pattern modifier, where it picks from things that we lack

// ---- patterns (parse_pattern.cpp), wherever they pick from: pigments, normals, textures, densities, functions

// Reads what a list pattern picks from (colours, pigments, textures ...), where it stands: behind `checker` and the
// like, inside the braces of `object { ... }`.
using ListReader = std::function<void(const Pattern&)>;
// A pattern's word with what belongs to it. False, and nothing taken, if none stands here.
bool parse_pattern(Parser& p, Pattern& pattern, const ListReader& read_list);
// A word that shapes the pattern: turbulence, warp, waves, frequency, words of single patterns. Likewise.
bool parse_pattern_modifier(Parser& p, Pattern& pattern);
// The block behind `pattern`, in functions and images.
Pattern parse_pattern_block(Parser& p);
// With what the scene says at this place (noise, pictures) filled in: what is evaluated while the scene is read.
Pattern prepared(Parser& p, Pattern pattern);
Pigment prepared(Parser& p, Pigment pigment);
bool parse_turbulence_word(Parser& p, Turbulence& turbulence); // octaves, omega, lambda
void parse_warp(Parser& p, Pattern& pattern);                  // the block behind `warp`
// The block of a map behind its word: a declared map, or `[position item] ...`, where `read` reads an item up to the
// `]`. Sorted by position. DeclaredBlock has to name BlendMap<T>.
template <class T, class F>
BlendMap<T> parse_blend_map(Parser& p, std::string_view what, F read);

template <class T, class F>
BlendMap<T> parse_blend_map(Parser& p, std::string_view what, F read) {
    BlendMap<T> map;
    const Token opener = peek(p);
    block(p, what, [&] {
        if (const auto* declared = accept_declared<BlendMap<T>>(p)) {
            map = *declared;
            return;
        }
        expect(p, '[', "to start an entry, such as [0.5 ...]");
        double position = 1; // `average` needs none
        if (at_expression(p)) position = parse_float(p), accept_comma(p);
        map.push_back({position, read()});
        expect(p, ']', "to end the entry");
        accept_comma(p);
    });
    if (map.empty()) fail(p, opener, std::string(what) + " needs at least one entry");
    std::stable_sort(map.begin(), map.end(),
                     [](const auto& a, const auto& b) { return a.position < b.position; });
    return map;
}

// ---- lights, camera, painting, settings
// -----------------------------------------------------------------------

LightSource parse_light_source(Parser& p);
Camera parse_camera(Parser& p);
// POV-Ray's area_light and projected_through, and what else a light says that changes only shadows and photons. False if
// no such word stands here.
bool parse_light_shadow(Parser& p, LightSource& light);
ColorFT parse_background(Parser& p);
SkySphere parse_sky_sphere(Parser& p);
Fog parse_fog(Parser& p);
Rainbow parse_rainbow(Parser& p);
// `radiosity { ... }` of global_settings; parse_radiosity.cpp.
void parse_radiosity(Parser& p);
PhotonRoles parse_object_photons(Parser& p);
// Behind `npr`: nothing, `on`, `off` or a block; changes `word`.
void parse_npr(Parser& p, PaintWord& word);
void parse_global_settings(Parser& p);
// At the end of the text: every object's style from the defaults and its own words.
void resolve_paint(Parser& p);

// ---- transforms
// -----------------------------------------------------------------------------------------------

bool accept_transform(Parser& p,
                      Transform& transform); // translate, rotate, scale, matrix, transform: one of them
Transform parse_transform(Parser& p);        // behind `transform`: a block, or the name of one
void apply_transform(const Transform& by, Object& object);
void apply_transform(const Transform& by, LightSource& light);
void apply_transform(const Transform& by, Texture& texture);
void apply_transform(const Transform& by, Pigment& pigment);
void apply_transform(const Transform& by, PaintWord& word);
void apply_transform(const Transform& by, Camera& camera);

// ---- what we know and lack
// ------------------------------------------------------------------------------------

// Skips `{ ... }` with everything in it.
void skip_block(Parser& p, std::string_view what);
// Skips a block if one stands here, else a single expression if one does.
void skip_argument(Parser& p, std::string_view what);
// "`fog` is not supported: it is left out", once for each feature.
void warn_unsupported(Parser& p, const Token& at, std::string_view feature, std::string_view consequence);

} // namespace pnr
