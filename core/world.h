// SPDX-License-Identifier: GPL-3.0-or-later
// What rays meet: the scene flattened, moved so that its centre is the origin (`world = scene - offset`), with its meshes
// read and its BVH built. Immutable once built; every pass takes it by const reference.
#pragma once

#include "core/camera.h"
#include "core/light.h"
#include "core/parallel.h"
#include "core/scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pnr {

struct Geometry; // BVH, triangles, analytic shapes: geometry.h

// How a surface answers to light. One for each textured leaf; index 0 is POV-Ray's default (black).
struct Material {
    Texture texture;                         // its transforms: pattern space -> world space
    std::optional<Texture> interior_texture; // of the side that is met from inside
    Interior interior;
    int interior_id = 0; // the same for all that share an interior; 0: no interior was said, rays go straight through
    PhotonRoles photons;
    bool double_illuminate = false;
};

inline const Texture& side_texture(const Material& material, bool inside) {
    return inside && material.interior_texture ? *material.interior_texture : material.texture;
}

// What the scene calls an object; the index into World::objects is its number (design.md section 5): top-level
// statements from 1 in the order of the text; inside a union a child with its own `npr` word is an object of its own,
// numbered where it stands after its parent. [0] is "nothing".
struct WorldObject {
    std::string name;  // declared name, or the shape's word
    SourceRef said_at;
    bool npr = false;
    PaintStyle paint;  // seeds in world space; directions as said
    Bounds bounds;     // world space
};

// One leaf's non-geometric side; Hit::surface indexes World::surfaces.
struct Surface {
    int object = 0;
    int material = 0;
    int light = -1;    // >= 0: this is the emitter of that light
    int light_group = 0; // see Object
    bool global_lights = true, hollow = false, no_radiosity = false;
    bool closed = true;  // it bounds a solid: who passes it goes in or out
    bool no_shadow = false, no_image = false, no_reflection = false;
};

struct World {
    Vec3 offset{0};    // scene = world + offset
    double radius = 1; // of a sphere about the origin that holds all bounded shapes and lights; > 0
    Camera camera;     // world space
    std::vector<WorldObject> objects;
    std::vector<Material> materials;
    std::vector<Surface> surfaces;
    std::vector<Light> lights; // world space; emitters have their radiance resolved
    Atmosphere atmosphere; // world space
    int camera_solids = 0; // solids without `hollow` about the camera: fog is not seen in them
    Color ambient_light{1};
    Color irid_wavelength{0.70f, 0.52f, 0.48f};
    Illumination illumination = Illumination::raytraced;
    bool has_specular = false; // some surface reflects or refracts
    bool has_paint = false;    // some object is painted
    bool caustics_apart = false; // photons bring caustics alone
    bool ambient_glows = false;  // with radiosity, ambient terms stay as light of the surfaces' own
    bool tinted_shadows = false; // some surface that throws a shadow lets light through
    std::shared_ptr<const Geometry> geometry;
    std::vector<std::string> notes; // what was done to meshes and the like, for stats and the terminal
};

// Reads mesh files and pictures, flattens, builds the BVH. Throws SceneError for what cannot be built (an unreadable or
// broken mesh, a non-finite coordinate) and FileError for files that cannot be opened.
World build_world(const Scene& scene, const Settings& settings);

// Whether the light shines on the surface: light_group.
inline bool shines_on(const Light& light, const Surface& surface) {
    return light.said.group == 0 ? surface.global_lights : light.said.group == surface.light_group;
}

// ---- rays -----------------------------------------------------------------------------------------------------

// Which flags hide a surface from a ray.
// blocker: shadow rays as far as surfaces stop them that let no light through.
// gather: of radiosity.
enum class RayKind { camera, specular, shadow, photon, blocker, gather };

struct Hit {
    double t = infinity;   // in units of the ray's direction
    Vec3 position{0};      // on the surface, refined; within `error` of it
    Vec3 normal{0};        // geometric, unit, to the outside as modelled: flip it to face the viewer
    Vec3 shading_normal{0};// unit, same side as normal; differs on smooth meshes
    Vec2 uv{0};
    std::uint32_t surface = 0;   // index into World::surfaces
    std::uint32_t primitive = 0; // stable number of the primitive (mesh triangles count apart), for equality tests
    double error = 0;      // bound on the distance of position to the true surface, world units
    std::uint32_t leaf = 0;      // whose geometry it is: an index into geometry_items; `surface` may be another's
    // Where textures run into one another, in a triangle with three or between the parts of a blob: surfaces and their
    // shares, the largest first, which is `surface`; the shares' sum is 1, or 0: there is no mixture.
    std::array<std::uint32_t, 3> mixed{};
    Vec3f shares{0};
};

std::optional<Hit> closest_hit(const World& world, const Ray& ray, RayKind kind);
// Whether anything lies in (t_min, t_max).
bool is_occluded(const World& world, const Ray& ray, RayKind kind);

// What patterns want to know of a hit; `direction` is the ray's, unit.
inline SurfacePoint surface_point(const Hit& hit, Vec3 direction) {
    return {hit.position, hit.uv, hit.shading_normal, direction};
}
// The same with the normal on the side that the ray meets.
inline SurfacePoint facing_point(const Hit& hit, Vec3 direction) {
    SurfacePoint point = surface_point(hit, direction);
    if (glm::dot(hit.normal, direction) > 0) point.normal = -point.normal;
    return point;
}

// The ray that leaves a hit towards `direction` (unit): its origin is moved off the surface to the direction's side by the
// hit's error bound, never by a loose constant.
Ray leave(const Hit& hit, Vec3 direction, double t_max = infinity);
// The segment from a hit to a point, for shadow rays: ends short of the point by its error.
Ray connect(const Hit& hit, Vec3 point, double point_error = 0);

} // namespace pnr
