// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/world.h"

#include "core/geometry.h"
#include "core/material.h"
#include "core/mesh_io.h"
#include "core/mesh_repair.h"
#include "core/pattern_assets.h"
#include "core/probe.h"
#include "core/scene_check.h"
#include "core/shape_field.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace pnr {

namespace {

// ---- checks
// ---------------------------------------------------------------------------------------------------

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool is_finite(const Transform& t) {
    for (int column = 0; column < 4; ++column)
        if (!is_finite(Vec3(t.matrix[column])) || !is_finite(Vec3(t.inverse[column]))) return false;
    return true;
}

void require(bool fine, const SourceRef& where, const char* text) {
    if (!fine) throw SceneError(where, text);
}

// ---- meshes
// --------------------------------------------------------------------------------------

// Each file is read once, each mesh worked on and smoothed once, however many objects show it.
struct Assets {
    using Work = std::tuple<const MeshData*, bool, int, int>;
    std::map<std::string, std::shared_ptr<const MeshData>> meshes;
    std::map<const MeshData*, std::shared_ptr<const MeshData>> smooth;
    std::map<Work, std::shared_ptr<const MeshData>> worked_on;
    std::map<const void*, Shape> fields; // by what was said of them

    std::vector<std::string> notes;

    std::shared_ptr<const MeshData> mesh(const Mesh& said) {
        std::shared_ptr<const MeshData> data = said.data;
        if (!data) {
            auto& entry = meshes[said.file];
            if (!entry) entry = std::make_shared<const MeshData>(read_mesh(said.file, said.said_at));
            data = entry;
        }
        if (checked.insert(data.get()).second) {
            check(*data, said);
            originals.push_back(data); // its address is a key: it must not be given to another mesh
        }
        const bool smooth_already = !data->normals.empty();
        if (said.repair || said.subdivide > 0 || said.simplify > 0) data = worked(data, said);
        return (said.smooth || smooth_already) && data->normals.empty() ? smoothed(data) : data;
    }

    // Isosurfaces and height fields made ready for rays, parametric shapes as meshes, once for all copies.
    Shape field(const Shape& said, const void* key) {
        const auto [entry, is_new] = fields.try_emplace(key);
        if (!is_new) return entry->second;
        if (const auto* parametric = std::get_if<Parametric>(&said)) {
            Mesh mesh;
            mesh.data = std::make_shared<const MeshData>(tessellate(*parametric));
            mesh.smooth = true;
            entry->second = std::move(mesh);
        } else {
            entry->second = prepare_field_shape(said);
        }
        return entry->second;
    }

private:
    static void check(const MeshData& data, const Mesh& said) {
        const auto fits = [&](const auto& list, std::size_t count) {
            if (!list.empty() && list.size() != data.triangles.size()) return false;
            return std::all_of(list.begin(), list.end(),
                               [&](const auto& t) { return t[0] < count && t[1] < count && t[2] < count; });
        };
        require(fits(data.triangles, data.positions.size()), said.said_at,
                "a face names a vertex that does not exist");
        require(fits(data.normal_triangles, data.normals.size()) &&
                    data.normals.empty() == data.normal_triangles.empty(),
                said.said_at, "a face names a normal that does not exist");
        require(fits(data.uv_triangles, data.uvs.size()) && data.uvs.empty() == data.uv_triangles.empty(),
                said.said_at, "a face names a texture point that does not exist");
    }

    std::shared_ptr<const MeshData> worked(const std::shared_ptr<const MeshData>& data, const Mesh& said) {
        auto& entry = worked_on[{data.get(), said.repair, said.subdivide, said.simplify}];
        if (!entry) entry = std::make_shared<const MeshData>(work_on_mesh(*data, said, notes));
        return entry;
    }

    std::shared_ptr<const MeshData> smoothed(const std::shared_ptr<const MeshData>& data) {
        auto& entry = smooth[data.get()];
        if (!entry) {
            MeshData copy = *data;
            copy.normals = area_weighted_normals(copy.positions, copy.triangles);
            copy.normal_triangles = copy.triangles;
            entry = std::make_shared<const MeshData>(std::move(copy));
        }
        return entry;
    }
    std::set<const MeshData*> checked;
    std::vector<std::shared_ptr<const MeshData>> originals;
};

// ---- flattening
// -----------------------------------------------------------------------------------------------

Bounds common(const Bounds& a, const Bounds& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

bool is_plain_union(const Object& object) {
    return !object.shape && object.combination == Combination::unite && !object.inverse;
}

// Tells apart what must be made ready for rays; null for all other shapes.
const void* field_key(const Shape& shape) {
    if (const auto* s = std::get_if<Isosurface>(&shape)) return s->data.get();
    if (const auto* s = std::get_if<HeightField>(&shape)) return s->data.get();
    if (const auto* s = std::get_if<Parametric>(&shape)) return s->data.get();
    return nullptr;
}

// Who passes its surface goes in or out of something.
bool bounds_a_solid(const Shape& shape) {
    return !std::holds_alternative<Disc>(shape) && !std::holds_alternative<Mesh>(shape) &&
           !std::holds_alternative<BicubicPatch>(shape) && !std::holds_alternative<Polygon>(shape) &&
           !std::holds_alternative<Parametric>(shape);
}

const char* group_name(Combination combination) {
    switch (combination) {
    case Combination::merge:
        return "merge";
    case Combination::intersect:
        return "intersection";
    case Combination::differ:
        return "difference";
    default:
        return "union";
    }
}

// What a child gets from its parents where it says nothing itself.
struct Inherited {
    const Texture* texture = nullptr;
    const Texture* interior_texture = nullptr;
    const Interior* interior = nullptr;
    const PhotonRoles* photons = nullptr;
    const PaintWord* npr = nullptr;
    std::vector<std::uint32_t> clips; // nodes of the solids that clip it
    Bounds limits{Vec3(-infinity), Vec3(infinity)}; // bounded_by
    int object = 0;
    int light_group = 0;
    bool global_lights = true, hollow = false, no_radiosity = false;
    bool cutaway = false;
    bool unseen = false; // clips: they have no surface
    bool double_illuminate = false;
    bool no_shadow = false, no_image = false, no_reflection = false;
};

struct Builder {
    const Scene& scene;
    World world;
    Assets assets;
    PatternAssets pattern_assets{};
    std::vector<GeometryItem> items; // in scene space until the offset is known
    std::vector<CsgNode> solids{};
    std::vector<Surface> parts{}; // of shapes with textures of their own; they come behind the items' surfaces
    std::map<const Interior*, int> interior_ids{};

    int number_object(const Object& object, const PaintWord* word) {
        WorldObject entry;
        entry.name = !object.name.empty() ? object.name : object.shape ? shape_name(*object.shape) : group_name(object.combination);
        entry.said_at = object.said_at;
        entry.npr = word && word->on;
        if (word) entry.paint = word->style;
        world.objects.push_back(std::move(entry));
        return static_cast<int>(world.objects.size()) - 1;
    }

    int add_material(const Inherited& from) {
        if (!from.texture && !from.interior_texture && !from.interior && !from.photons) return 0;
        Material material;
        if (from.texture) material.texture = *from.texture;
        if (from.interior_texture) material.interior_texture = *from.interior_texture;
        if (from.interior) {
            material.interior = *from.interior;
            material.interior_id =
                interior_ids.try_emplace(from.interior, static_cast<int>(interior_ids.size()) + 1).first->second;
        }
        material.double_illuminate = from.double_illuminate;
        if (from.photons) material.photons = *from.photons;
        for (Texture* texture : {&material.texture, material.interior_texture ? &*material.interior_texture : nullptr})
            if (texture) for_each_pattern(*texture, [&](Pattern& pattern) { prepare_pattern(pattern, pattern_assets); });
        world.materials.push_back(std::move(material));
        return static_cast<int>(world.materials.size()) - 1;
    }

    // `bare`: it may show another's texture.
    void add_item(GeometryItem item, Surface surface, bool bare) {
        if (surface.no_image) item.hidden_from |= ray_bit(RayKind::camera);
        if (surface.no_reflection) item.hidden_from |= ray_bit(RayKind::specular);
        if (surface.no_shadow) item.hidden_from |= ray_bit(RayKind::shadow);
        if (surface.no_radiosity) item.hidden_from |= ray_bit(RayKind::gather);
        const bool clear = surface.light < 0 && lets_light_through(world.materials[static_cast<std::size_t>(surface.material)]);
        if (surface.no_shadow || clear || bare) item.hidden_from |= ray_bit(RayKind::blocker);
        world.tinted_shadows |= !surface.no_shadow && (clear || bare);
        items.push_back(std::move(item));
        world.surfaces.push_back(surface);
    }

    // What the object's own words make of what it has from its parents.
    Inherited inherit(const Object& object, Inherited from, bool top) {
        require(is_finite(object.transform), object.said_at, "a transform is not finite");
        if (object.texture) from.texture = &*object.texture;
        if (object.interior_texture) from.interior_texture = &*object.interior_texture;
        if (object.interior) from.interior = &*object.interior;
        if (object.photons) from.photons = &*object.photons;
        if (object.npr) from.npr = &*object.npr;
        if (!from.unseen && (top || object.npr)) from.object = number_object(object, from.npr);
        from.no_shadow |= object.no_shadow;
        from.no_image |= object.no_image;
        from.no_reflection |= object.no_reflection;
        from.double_illuminate |= object.double_illuminate;
        from.cutaway |= object.cutaway_textures;
        from.hollow |= object.hollow;
        from.no_radiosity |= object.no_radiosity;
        if (object.light_group > 0) from.light_group = object.light_group, from.global_lights = object.global_lights;
        for (const Object& bound : object.bounds) from.limits = common(from.limits, object_bounds(bound));
        return from;
    }

    // A plain union's children stand in the scene by themselves; whatever needs more than its own surface to know where
    // it is seen becomes a tree of solids. Clips go down to a union's children.
    void add_object(const Object& object, const Inherited& above, bool top) {
        Inherited from = inherit(object, above, top);
        for (const Object& clip : object.clips) from.clips.push_back(add_clip(clip));
        if (is_plain_union(object)) {
            for (const Object& child : object.children) add_object(child, from, false);
            return;
        }
        if (object.shape && from.clips.empty()) {
            add_shape(object, from, object.inverse);
            return;
        }
        std::vector<std::uint32_t> clips;
        std::swap(clips, from.clips);
        clipped(add_unclipped(object, from, object.inverse), std::move(clips));
    }

    std::uint32_t add_node(CsgNode node) {
        solids.push_back(std::move(node));
        return static_cast<std::uint32_t>(solids.size()) - 1;
    }

    std::uint32_t clipped(std::uint32_t solid, std::vector<std::uint32_t> clips) {
        if (clips.empty()) return solid;
        CsgNode node;
        node.kind = CsgKind::clipped;
        node.children = std::move(clips);
        node.children.insert(node.children.begin(), solid);
        return add_node(std::move(node));
    }

    // A solid that is never seen itself.
    std::uint32_t add_clip(const Object& object) {
        Inherited from;
        from.unseen = true;
        return add_solid(object, from, false);
    }

    std::uint32_t add_solid(const Object& object, const Inherited& above, bool inverse) {
        Inherited from = inherit(object, above, false);
        std::vector<std::uint32_t> clips;
        for (const Object& clip : object.clips) clips.push_back(add_clip(clip));
        return clipped(add_unclipped(object, from, inverse != object.inverse), std::move(clips));
    }

    // The inverse of a union is the intersection of the inverses, and the other way round, as in POV-Ray.
    std::uint32_t add_unclipped(const Object& object, const Inherited& from, bool inverse) {
        CsgNode node;
        if (object.shape) {
            node.item = add_shape(object, from, inverse);
            node.bare = from.cutaway && !from.texture;
            return add_node(std::move(node));
        }
        const bool differs = object.combination == Combination::differ;
        const bool common = differs || object.combination == Combination::intersect;
        node.kind = common != inverse ? CsgKind::all
                    : object.combination == Combination::merge && !inverse ? CsgKind::merged
                                                                            : CsgKind::any;
        node.first_alone = differs;
        node.cutaway = object.cutaway_textures;
        for (const Object& child : object.children) {
            if (!child.shape && child.children.empty()) { // lights alone, or what we lack
                if (!differs || !node.children.empty()) continue;
                node.kind = inverse ? CsgKind::all : CsgKind::any; // nothing, less whatever follows
                return add_node(std::move(node));
            }
            node.children.push_back(add_solid(child, from, inverse != (differs && !node.children.empty())));
        }
        return add_node(std::move(node));
    }

    std::uint32_t add_shape(const Object& object, const Inherited& from, bool inverse) {
        require(has_finite_numbers(*object.shape), object.said_at, "a coordinate is not finite");
        GeometryItem item;
        item.to_world = object.transform;
        item.inverse = inverse;
        item.limits = from.limits;
        if (from.unseen) item.hidden_from = hidden_from_all;
        if (const auto* mesh = std::get_if<Mesh>(&*object.shape)) {
            Mesh loaded = *mesh;
            loaded.data = assets.mesh(*mesh);
            item.form = Shape(std::move(loaded));
        } else if (const auto* patch = std::get_if<BicubicPatch>(&*object.shape)) {
            Mesh flat;
            flat.data = std::make_shared<const MeshData>(tessellate(*patch));
            flat.smooth = true;
            item.form = Shape(std::move(flat));
        } else if (const void* key = field_key(*object.shape)) {
            item.form = assets.field(*object.shape, key);
        } else {
            item.form = *object.shape;
        }
        Surface surface;
        surface.object = from.object;
        if (!from.unseen) surface.material = add_material(from);
        if (from.photons && from.photons->pass_through) item.hidden_from |= ray_bit(RayKind::photon);
        surface.no_shadow = from.no_shadow;
        surface.no_image = from.no_image;
        surface.no_reflection = from.no_reflection;
        surface.light_group = from.light_group;
        surface.global_lights = from.global_lights;
        surface.hollow = from.hollow;
        surface.no_radiosity = from.no_radiosity;
        surface.closed = bounds_a_solid(*object.shape);
        const Mesh* from_file = object.shape ? std::get_if<Mesh>(&*object.shape) : nullptr;
        const bool overruled = from_file && !from_file->file.empty() && from.texture; // a file's own textures
        if (const PartTextures* textures = part_textures(item); textures && !from.unseen && !overruled)
            item.first_part = add_parts(*textures, from, object.transform, surface);
        add_item(std::move(item), surface, from.cutaway && !from.texture);
        return static_cast<std::uint32_t>(items.size()) - 1;
    }

    static const PartTextures* part_textures(const GeometryItem& item) {
        const Shape& shape = std::get<Shape>(item.form);
        if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->data->textures.get();
        if (const auto* blob = std::get_if<Blob>(&shape)) return blob->textures.get();
        return nullptr;
    }

    // The number of the first among `parts`.
    std::uint32_t add_parts(const PartTextures& textures, Inherited from, const Transform& to_scene, Surface surface) {
        const auto first = static_cast<std::uint32_t>(parts.size());
        for (Texture texture : textures.list) {
            transform_texture(texture, to_scene);
            from.texture = &texture;
            surface.material = add_material(from);
            parts.push_back(surface);
        }
        return first;
    }

    void append_parts() {
        for (GeometryItem& item : items)
            if (item.first_part != no_texture) item.first_part += static_cast<std::uint32_t>(items.size());
        world.surfaces.insert(world.surfaces.end(), parts.begin(), parts.end());
    }

    // The emitting area of a light, with the light's position as the origin of its own space.
    void add_emitter(const LightSource& light, int index) {
        const Emitter& e = *light.emitter;
        require(is_finite(e.axis) && is_finite(e.u) && is_finite(e.v) && std::isfinite(e.radius),
                light.said_at, "the emitter is not finite");
        GeometryItem item;
        item.to_world = translation(light.position);
        switch (e.shape) {
        case EmitterShape::sphere:
            item.form = Shape(Sphere{Vec3(0), e.radius});
            break;
        case EmitterShape::hemisphere:
            item.form = Hemisphere{Vec3(0), e.radius, e.axis};
            break;
        case EmitterShape::disc:
            item.form = Shape(Disc{Vec3(0), e.axis, e.radius, 0});
            break;
        case EmitterShape::rectangle:
            item.form = Parallelogram{-0.5 * (e.u + e.v), e.u, e.v};
            break;
        }
        Surface surface;
        surface.light = index;
        surface.no_image = light.no_image;
        add_item(std::move(item), surface, false);
    }

    Bounds bounded() const;
    void move_to_center();
    void find_object_bounds(const std::vector<Bounds>& boxes);
};

bool is_bounded(const Bounds& b) { return !is_empty(b) && is_finite(b.low) && is_finite(b.high); }

// All that has an extent: bounded shapes and the lights; the camera alone where there is nothing else.
Bounds Builder::bounded() const {
    Bounds all;
    for (const Bounds& b : seen_bounds(items, solids))
        if (is_bounded(b)) all = merge(all, b);
    for (const LightSource& light : scene.lights) all = merge(all, light.position);
    return is_empty(all) ? merge(all, scene.camera.location) : all;
}

void Builder::move_to_center() {
    const Bounds all = bounded();
    world.offset = 0.5 * all.low + 0.5 * all.high;
    const double radius = 0.5 * glm::length(all.high - all.low);
    world.radius = radius > 0 ? radius : 1;
    const Transform move = translation(-world.offset);
    for (GeometryItem& item : items) {
        item.to_world = then(item.to_world, move);
        item.limits = {item.limits.low - world.offset, item.limits.high - world.offset};
    }
    for (Material& material : world.materials) {
        transform_texture(material.texture, move);
        if (material.interior_texture) transform_texture(*material.interior_texture, move);
    }
    for (WorldObject& object : world.objects) {
        object.paint.field_point -= world.offset;
        for (Seed& seed : object.paint.seeds) seed.position -= world.offset;
    }
    world.camera = scene.camera;
    world.camera.mesh_offset = -world.offset;
    if (!world.camera.mesh) world.camera.location -= world.offset;
    world.atmosphere = scene.atmosphere;
    for (Pigment& layer : world.atmosphere.sky.layers) {
        Texture bearer;
        std::swap(bearer.pigment, layer);
        for_each_pattern(bearer, [&](Pattern& pattern) { prepare_pattern(pattern, pattern_assets); });
        std::swap(bearer.pigment, layer);
    }
    for (Fog& fog : world.atmosphere.fogs) fog.offset -= glm::dot(world.offset, fog.up);
    for (LightSource light : scene.lights) {
        light.position -= world.offset;
        light.point_at -= world.offset;
        world.lights.push_back(make_light(light));
        Light& made = world.lights.back();
        made.offset = world.offset;
        if (!light.projected_through.empty()) made.window = make_probe(light.projected_through.front());
    }
}

void Builder::find_object_bounds(const std::vector<Bounds>& boxes) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        Bounds& b = world.objects[static_cast<std::size_t>(world.surfaces[i].object)].bounds;
        b = merge(b, boxes[i]);
    }
}

Illumination choose_illumination(const Scene& scene, const World& world, const PhotonSettings& photons) {
    const bool emitters = std::any_of(scene.lights.begin(), scene.lights.end(),
                                      [](const LightSource& light) { return light.emitter.has_value(); });
    if (emitters || world.has_paint || (scene.radiosity && !scene.povray) || photons.global.value_or(false))
        return Illumination::photon_mapped;
    if (scene.radiosity) return Illumination::radiosity;
    return photons.wanted ? Illumination::caustics : Illumination::raytraced;
}

void check_lights_and_camera(const Scene& scene) {
    for (const LightSource& light : scene.lights)
        require(is_finite(light.position) && is_finite(light.point_at) && is_finite(Vec3(light.color)),
                light.said_at, "the light is not finite");
    const Camera& c = scene.camera;
    require(is_finite(c.location) && is_finite(c.direction) && is_finite(c.right) && is_finite(c.up), {},
            "the camera is not finite");
}

} // namespace

World build_world(const Scene& scene, const Settings& settings) {
    check_lights_and_camera(scene);
    Builder builder{scene, {}, {}, {scene.assumed_gamma, scene.noise_generator, scene.number_of_waves}, {}};
    World& world = builder.world;
    world.objects.emplace_back();
    world.materials.emplace_back();
    for (const Object& object : scene.objects) builder.add_object(object, {}, true);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].emitter) builder.add_emitter(scene.lights[i], static_cast<int>(i));
    builder.append_parts();
    builder.move_to_center();
    builder.find_object_bounds(seen_bounds(builder.items, builder.solids));
    if (!scene.atmosphere.fogs.empty())
        world.camera_solids = static_cast<int>(solids_about(scene.objects, scene.camera.location).size());
    world.ambient_light = scene.ambient_light;
    world.irid_wavelength = scene.irid_wavelength;
    world.has_paint =
        std::any_of(world.objects.begin(), world.objects.end(), [](const WorldObject& o) { return o.npr; });
    world.has_specular = std::any_of(world.materials.begin(), world.materials.end(), is_specular);
    world.illumination = choose_illumination(scene, world, settings.photons);
    world.caustics_apart = world.illumination != Illumination::photon_mapped && settings.photons.wanted;
    world.ambient_glows = scene.povray && scene.version < 3.7;
    world.notes = std::move(builder.assets.notes);
    world.geometry = make_geometry(std::move(builder.items), builder.solids);
    return std::move(world);
}

// ---- rays
// -----------------------------------------------------------------------------------------------------

std::optional<Hit> closest_hit(const World& world, const Ray& ray, RayKind kind) {
    std::optional<Hit> hit = closest_hit(*world.geometry, ray, kind);
    if (!hit) return hit;
    const Shape* shape = std::get_if<Shape>(&geometry_items(*world.geometry)[hit->leaf].form);
    if (!shape || !has_uv(*shape)) hit->uv = Vec2(hit->position + world.offset);
    return hit;
}

bool is_occluded(const World& world, const Ray& ray, RayKind kind) {
    return is_occluded(*world.geometry, ray, kind);
}

namespace {

// Off the surface, to the side of the direction: once the bound to be beyond the true surface, once more for
// the rounding of whoever intersects that surface from here.
Vec3 off_surface(const Hit& hit, Vec3 direction) {
    const double side = glm::dot(direction, hit.normal) < 0 ? -1 : 1;
    return hit.position + (2 * side * hit.error) * hit.normal;
}

} // namespace

Ray leave(const Hit& hit, Vec3 direction, double t_max) {
    return {off_surface(hit, direction), direction, 0, t_max};
}

Ray connect(const Hit& hit, Vec3 point, double point_error) {
    const Vec3 origin = off_surface(hit, point - hit.position);
    const Vec3 way = point - origin;
    const double distance = glm::length(way);
    if (!(distance > 0)) return {origin, {0, 0, 1}, 0, 0};
    const double end = distance - 4 * (point_error + hit.error);
    return {origin, way / distance, 0, std::max(0.0, end)};
}

} // namespace pnr
