// SPDX-License-Identifier: GPL-3.0-or-later
// The scene as it was said: what the parser builds and build_world reads. Nothing is cached or accelerated here; mesh
// files and pictures are named, not loaded. All coordinates are the author's (scene space).
#pragma once

#include "core/atmosphere.h"
#include "core/boxed.h"
#include "core/camera.h"
#include "core/pigment.h"
#include "core/settings.h"
#include "core/shape.h"
#include "core/texture.h"
#include "core/types.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pnr {

// Textures that a shape's triangles or components number, in the shape's own space.
struct PartTextures {
    std::vector<Texture> list;
};

// Object-level `photons { ... }`. PSR and PA of [LW10 Table 1], in sequence: specular with probability
// specular_probability, else absorbed with absorption_probability, else diffuse. Unset: the finish decides.
struct PhotonRoles {
    std::optional<double> specular_probability, absorption_probability;
    bool target = false, reflection = false, refraction = false, collect = true; // POV-Ray's words
    bool pass_through = false; // photons do not meet the object
};

// An `npr` word or block. Unset: the parent's word counts, and at the top level: off. The parser fills `style` when the
// whole text is read: the base (default_style or paper_style), then what global_settings said, then what the block said.
struct PaintWord {
    bool on = false;
    PaintStyle style;
    std::optional<bool> paper_mode;                   // said here
    std::vector<std::function<void(PaintStyle&)>> said; // the block's items, in order; seeds stand in `style` itself
    bool own_axis = false;                            // `field along | around` was said here: its vectors stand in `style`
};

// ---- lights ---------------------------------------------------------------------------------------------------

enum class EmitterShape { sphere, hemisphere, disc, rectangle };

// The area that emits: Lambertian, opaque and black (design.md section 3). The light's position is the centre.
struct Emitter {
    EmitterShape shape = EmitterShape::sphere;
    double radius = 1;               // not for rectangle
    Vec3 axis{0, -1, 0};             // hemisphere: it bulges this way; disc: it emits this way. Unit.
    Vec3 u{1, 0, 0}, v{0, 0, 1};     // rectangle: full edges; it emits towards cross(u, v)
    std::optional<double> radiance;  // W/(m^2 sr), one of the two, times the light's colour
    std::optional<double> power;     // W
};

// POV-Ray's area_light: points of a grid about the light's position; a lit point's shadow is the share of them that it
// does not see.
struct AreaGrid {
    Vec3 u{1, 0, 0}, v{0, 0, 1}; // full edges
    int columns = 1, rows = 1;
    int adaptive = 100;       // levels at which squares are halved even where their corners agree
    bool jitter = false;      // points stray within their squares
    bool circular = false;    // squares are bent to rings
    bool orient = false;      // it turns towards what it lights
    bool illuminates = false; // light, not only shadow, comes from the points (area_illumination)
};

struct Object;
struct LightSource {
    SourceRef said_at;
    Vec3 position{0};
    Color color{1};
    bool spotlight = false, parallel = false, cylinder = false, shadowless = false;
    Vec3 point_at{0, 0, 1};
    double radius = 30, falloff = 45; // degrees from the axis: full inside the one, none beyond the other
    double tightness = 0;
    double fade_distance = 0, fade_power = 0;
    std::optional<Emitter> emitter;
    std::optional<AreaGrid> area;
    std::vector<Object> projected_through; // at most one: only light that went through it counts
    bool media_attenuation = false;        // fog dims it on its way
    int group = 0;                         // > 0: it lights only the objects of that light_group
    bool reflection_photons = true, refraction_photons = true; // POV-Ray's `photons` of lights
    std::vector<Object> looks_like;   // at most one; the parser moves it among the scene's objects
    bool no_image = false;            // an emitter hidden from camera rays alone
};

// ---- objects --------------------------------------------------------------------------------------------------

// How the children of a group make one thing.
enum class Combination {
    unite,     // all of them, with what lies inside others too
    merge,     // all of them, without the surfaces inside others
    intersect, // what all have in common
    differ,    // the first without the others
};

// One object statement: a shape, or a group of children. The parser applies transforms to everything already said in
// the block, so every transform here maps straight to scene space, children's too.
struct Object {
    std::string name;                 // of the #declare it was made from; empty if none
    SourceRef said_at;
    std::optional<Shape> shape;       // none: a group
    Combination combination = Combination::unite; // of a group
    std::vector<Object> children;     // of a group, in the order of the text
    std::vector<Object> clips;        // clipped_by: only what lies inside all of them is there
    std::vector<Object> bounds;       // bounded_by: believed where the object itself has no end
    bool cutaway_textures = false;    // children without a texture show what they cut through
    std::vector<LightSource> lights;  // that stand in a union; the parser moves them to Scene::lights
    int light_group = 0;              // > 0: lit by the lights of that group, and ...
    bool global_lights = true;        // ... by those of none
    Seldom<Transform> transform;      // shape's own space -> scene space
    Boxed<Texture> texture;           // children without one use their parent's
    Boxed<Texture> interior_texture;  // of the inner side; likewise
    Boxed<Interior> interior;         // likewise
    Boxed<PhotonRoles> photons;
    Boxed<PaintWord> npr;
    bool no_shadow = false, no_image = false, no_reflection = false, no_radiosity = false, hollow = false, inverse = false;
    bool double_illuminate = false;
    bool uv_mapping = false; // textures said behind it are laid by the surface's own coordinates
};

struct Scene {
    std::string file;                // as given on the command line; "default.pnr" for the embedded one
    std::uint64_t hash = 0;          // of the text after expansion, with all included files
    Camera camera;
    bool has_camera = false;
    std::vector<Object> objects;     // top-level statements, in the order of the text
    std::vector<LightSource> lights;
    Atmosphere atmosphere;
    Color ambient_light{1};          // global_settings
    Color irid_wavelength{0.70f, 0.52f, 0.48f}; // global_settings; likewise
    int noise_generator = 2, number_of_waves = 10; // of patterns that say none
    bool radiosity = false;          // a `radiosity {}` block: indirect light is wanted
    bool povray = false;             // a .pov file
    double version = 3.7;            // of POV-Ray, that the text asks for (#version)
    // What a value v of the finished picture means: linear light v^assumed_gamma, or, if 0, v through the sRGB curve. Applied
    // by whoever writes the picture; 1 but for POV-Ray scenes that say otherwise.
    double assumed_gamma = 1;
    PaintStyle paint_defaults;       // global_settings { npr { ... } }; already merged into every object's style
};

} // namespace pnr
