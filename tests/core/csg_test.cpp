// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of solids against point membership, worked out by the tests themselves, and against what is known of
// simple bodies.
#include "core/csg.h"

#include "core/closest_point.h"
#include "core/geometry.h"
#include "core/rng.h"
#include "core/world.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pnr {
namespace {

Object solid(Shape shape, const Transform& place = {}) {
    Object object;
    object.shape = std::move(shape);
    object.texture = Texture{};
    object.transform = place;
    return object;
}

Object group(Combination combination, std::vector<Object> children) {
    Object object;
    object.combination = combination;
    object.children = std::move(children);
    return object;
}

World world_of(std::vector<Object> objects) {
    Scene scene;
    scene.objects = std::move(objects);
    return build_world(scene, {});
}

// ---- the oracle
// -----------------------------------------------------------------------------------------------------

bool inside(const Shape& shape, Vec3 p) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return glm::distance(p, s->center) < s->radius;
    if (const auto* b = std::get_if<Box>(&shape))
        return p.x > b->low.x && p.y > b->low.y && p.z > b->low.z && p.x < b->high.x && p.y < b->high.y &&
               p.z < b->high.z;
    if (const auto* plane = std::get_if<Plane>(&shape)) return glm::dot(plane->normal, p) < plane->distance;
    if (const auto* t = std::get_if<Torus>(&shape)) {
        const double ring = std::sqrt(p.x * p.x + p.z * p.z) - t->major;
        return ring * ring + p.y * p.y < t->minor * t->minor;
    }
    const auto& c = std::get<Cylinder>(shape);
    const Vec3 axis = glm::normalize(c.cap - c.base);
    const double height = glm::dot(p - c.base, axis);
    return height > 0 && height < glm::distance(c.base, c.cap) &&
           glm::length(p - c.base - height * axis) < c.radius;
}

bool inside(const Object& object, Vec3 p) {
    for (const Object& clip : object.clips)
        if (!inside(clip, p)) return false;
    bool is = object.shape && inside(*object.shape, transform_point(object.transform->inverse, p));
    const bool all =
        object.combination == Combination::intersect || object.combination == Combination::differ;
    for (std::size_t i = 0; i < object.children.size(); ++i) {
        const bool child =
            inside(object.children[i], p) != (object.combination == Combination::differ && i > 0);
        is = i == 0 ? child : all ? is && child : is || child;
    }
    return is != object.inverse;
}

std::vector<Hit> all_hits(const World& world, Ray ray) {
    std::vector<Hit> hits;
    while (const auto hit = closest_hit(world, ray, RayKind::camera)) {
        hits.push_back(*hit);
        ray.t_min = hit->t + 1e-9;
        if (hits.size() > 1000) break;
    }
    return hits;
}

Vec3 random_point(Rng& rng, double size) {
    return size * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

Ray random_ray(Rng& rng) {
    const Vec3 from = random_point(rng, 6), to = random_point(rng, 1.5);
    return {from, glm::normalize(to - from)};
}

// Between hits nothing may change; at a hit everything, unless inner surfaces of unions are seen.
void expect_hits_of(const World& world, const Object& object, const Ray& ray, bool inner_surfaces) {
    std::vector<double> ends{0};
    const std::vector<Hit> hits = all_hits(world, ray);
    for (const Hit& hit : hits) ends.push_back(hit.t);
    ends.push_back(ends.back() + 3);
    bool last = false;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const auto at = [&](double share) {
            const double t = ends[i] + share * (ends[i + 1] - ends[i]);
            return inside(object, world.offset + ray.origin + t * ray.direction);
        };
        if (ends[i + 1] - ends[i] < 1e-6) return; // edges: the samples would be on them
        const bool now = at(0.5);
        for (const double share : {1e-3, 0.1, 0.3, 0.7, 0.9, 0.999}) ASSERT_EQ(at(share), now) << i;
        if (i > 0) {
            ASSERT_TRUE(inner_surfaces || now != last) << "a surface where nothing changes";
            if (now != last) {
                // Normals point out of the solid.
                EXPECT_EQ(glm::dot(hits[i - 1].normal, ray.direction) < 0, now);
            }
        }
        last = now;
    }
}

Shape random_shape(Rng& rng) {
    switch (static_cast<int>(5 * rng.uniform())) {
    case 0:
        return Sphere{random_point(rng, 1), 0.4 + rng.uniform()};
    case 1: {
        const Vec3 low = random_point(rng, 1);
        return Box{low, low + Vec3(0.3 + rng.uniform(), 0.3 + rng.uniform(), 0.3 + rng.uniform())};
    }
    case 2:
        return Cylinder{random_point(rng, 1), random_point(rng, 1) + Vec3(0, 2, 0),
                        0.2 + 0.6 * rng.uniform()};
    case 3:
        return Torus{0.5 + rng.uniform(), 0.1 + 0.3 * rng.uniform()};
    default:
        return Plane{glm::normalize(random_point(rng, 1)), 0.5 * rng.uniform()};
    }
}

Object random_tree(Rng& rng, int depth, bool unions) {
    if (depth == 0 || rng.uniform() < 0.15) {
        const Transform place = then(scaling({0.6 + 0.8 * rng.uniform(), 0.6 + 0.8 * rng.uniform(), 1}),
                                     rotation(180.0 * random_point(rng, 1)));
        Object leaf = solid(random_shape(rng), place);
        leaf.inverse = rng.uniform() < 0.2;
        return leaf;
    }
    const Combination kinds[] = {Combination::merge, Combination::intersect, Combination::differ,
                                 Combination::unite};
    std::vector<Object> children;
    const int count = 2 + static_cast<int>(3 * rng.uniform());
    for (int i = 0; i < count; ++i) children.push_back(random_tree(rng, depth - 1, unions));
    Object tree = group(kinds[static_cast<int>((unions ? 4 : 3) * rng.uniform())], std::move(children));
    // The inverse of an intersection is a union with inner surfaces, as in POV-Ray.
    tree.inverse = unions && rng.uniform() < 0.2;
    return tree;
}

class CsgRandomTree : public testing::TestWithParam<bool> {};

TEST_P(CsgRandomTree, IsWhatItsPointsSay) {
    const bool unions = GetParam();
    int seen = 0;
    for (std::uint64_t tree = 0; tree < 150; ++tree) {
        Rng rng = make_rng(tree, Pass::test, 0);
        const Object object = random_tree(rng, 3, unions);
        const World world = world_of({object});
        for (int i = 0; i < 60; ++i) {
            const Ray ray = random_ray(rng);
            expect_hits_of(world, object, ray, true);
            ASSERT_FALSE(testing::Test::HasFatalFailure()) << "tree " << tree << ", ray " << i;
            const auto hit = closest_hit(world, ray, RayKind::camera);
            seen += hit.has_value();
            EXPECT_EQ(is_occluded(world, ray, RayKind::shadow), hit.has_value());
            if (!hit) continue;
            EXPECT_FALSE(
                is_occluded(world, {ray.origin, ray.direction, 0, hit->t * (1 - 1e-12)}, RayKind::shadow));
        }
    }
    EXPECT_GT(seen, 1000);
}

INSTANTIATE_TEST_SUITE_P(Csg, CsgRandomTree, testing::Bool());

// Without unions each hit is a change from inside to outside or back.
TEST(Csg, DifferencesAndMergesHaveNoInnerSurfaces) {
    Rng rng = make_rng(3, Pass::test, 0);
    for (int tree = 0; tree < 60; ++tree) {
        std::vector<Object> balls, holes;
        for (int i = 0; i < 6; ++i) {
            balls.push_back(solid(Sphere{random_point(rng, 1), 0.3 + 0.4 * rng.uniform()}));
            holes.push_back(solid(Box{random_point(rng, 1) - Vec3(0.2), random_point(rng, 1) + Vec3(0.2)}));
        }
        for (Object& hole : holes) {
            Box& box = std::get<Box>(*hole.shape);
            box = {glm::min(box.low, box.high), glm::max(box.low, box.high)};
        }
        const Object object =
            group(Combination::differ, {group(Combination::merge, balls), group(Combination::merge, holes)});
        const World world = world_of({object});
        for (int i = 0; i < 60; ++i) {
            expect_hits_of(world, object, random_ray(rng), false);
            ASSERT_FALSE(testing::Test::HasFatalFailure()) << tree << " " << i;
        }
    }
}

// ---- bodies that are known
// -----------------------------------------------------------------------------------------------------

// The volume by parallel rays along z over a square of half width `half`, on an n by n grid.
double volume(const World& world, double half, int n) {
    double sum = 0;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const Ray ray{{half * (2 * (column + 0.5) / n - 1), half * (2 * (row + 0.5) / n - 1), -10},
                          {0, 0, 1}};
            for (const Hit& hit : all_hits(world, ray)) sum += (hit.normal.z < 0 ? -1 : 1) * hit.t;
        }
    return sum * (2 * half / n) * (2 * half / n);
}

TEST(Csg, LensOfTwoSpheres) {
    const World world = world_of(
        {group(Combination::intersect, {solid(Sphere{{0, 0, -0.5}, 1}), solid(Sphere{{0, 0, 0.5}, 1})})});
    const double expected = 2 * pi * 0.25 * (3 - 0.5) / 3; // two caps of height 1/2
    EXPECT_NEAR(volume(world, 1, 200), expected, 2e-3 * expected);
    const auto hit = closest_hit(world, {{0, 0, -3}, {0, 0, 1}}, RayKind::camera);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 2.5, 1e-12); // the far sphere's near side
    EXPECT_EQ(hit->surface, 1u);
    // The rim, and the box: no wider than the lens.
    EXPECT_FALSE(closest_hit(world, {{0.867, 0, -3}, {0, 0, 1}}, RayKind::camera));
    EXPECT_TRUE(closest_hit(world, {{0.865, 0, -3}, {0, 0, 1}}, RayKind::camera));
    EXPECT_NEAR(world.objects[1].bounds.high.z, 0.5, 1e-9);
}

TEST(Csg, BoxWithoutASphere) {
    const World world =
        world_of({group(Combination::differ, {solid(Box{Vec3(-1), Vec3(1)}), solid(Sphere{Vec3(0), 1.2})})});
    const double cap = pi * 0.2 * 0.2 * (3 * 1.2 - 0.2) / 3; // what of the ball sticks out of each face
    const double expected = 8 - (4 * pi / 3 * 1.2 * 1.2 * 1.2 - 6 * cap);
    EXPECT_NEAR(volume(world, 1, 200), expected, 2e-3 * expected);
}

TEST(Csg, PlanesMakeABox) {
    std::vector<Object> planes;
    for (int k = 0; k < 3; ++k)
        for (const double side : {-1.0, 1.0}) {
            Vec3 n(0);
            n[k] = side;
            planes.push_back(solid(Plane{n, 1}));
        }
    planes[5] = solid(Plane{{0, 0, -1}, -1}); // the same one, said inversely
    planes[5].inverse = true;
    const World world = world_of({group(Combination::intersect, planes)});
    EXPECT_EQ(geometry_stats(*world.geometry).unbounded, 0);
    EXPECT_NEAR(world.radius, std::sqrt(3.0), 1e-9);
    const World box = world_of({solid(Box{Vec3(-1), Vec3(1)})});
    Rng rng = make_rng(4, Pass::test, 0);
    for (int i = 0; i < 2000; ++i) {
        const Ray ray = random_ray(rng);
        const auto a = closest_hit(world, ray, RayKind::camera), b = closest_hit(box, ray, RayKind::camera);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_NEAR(a->t, b->t, 1e-9);
        EXPECT_LT(glm::length(a->normal - b->normal), 1e-9);
    }
}

// Flush faces, through transforms that round: a hole is open, what touches is one.
TEST(Csg, FacesThatCoincide) {
    Rng rng = make_rng(5, Pass::test, 0);
    for (int i = 0; i < 300; ++i) {
        const Transform turn =
            then(scaling(Vec3(0.1 + rng.uniform())), rotation(180.0 * random_point(rng, 1)));
        const auto turned = [&](const Box& box) { return solid(box, turn); };
        const auto along = [&](double x, double y) {
            const Vec3 from = transform_point(turn.matrix, {x, y, -5}),
                       to = transform_point(turn.matrix, {x, y, 5});
            return Ray{from, glm::normalize(to - from)};
        };
        const double x = 1.6 * rng.uniform() - 0.8, y = 1.6 * rng.uniform() - 0.8;
        const double size = glm::length(Vec3(turn.matrix[0]));
        const Box whole{Vec3(-1), Vec3(1)};
        const World tunnel = world_of(
            {group(Combination::differ, {turned(whole), turned({{-0.9, -0.9, -1}, {0.9, 0.9, 1}})})});
        EXPECT_EQ(all_hits(tunnel, along(x, y)).size(), 0u);
        EXPECT_EQ(all_hits(tunnel, along(0.95, y)).size(), 2u);
        const World nothing = world_of(
            {group(Combination::differ, {turned(whole), turned(whole)}), turned({Vec3(-9), Vec3(-8)})});
        EXPECT_EQ(all_hits(nothing, along(x, y)).size(), 0u);
        const World same = world_of({group(Combination::intersect, {turned(whole), turned(whole)})});
        const auto hits = all_hits(same, along(x, y));
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_EQ(hits[0].surface, 0u); // the first leaf's, not whichever rounding likes
        EXPECT_NEAR(hits[1].t - hits[0].t, 2 * size, 1e-9);
        const World touching = world_of(
            {group(Combination::merge, {turned({Vec3(-1), {1, 1, 0}}), turned({{-1, -1, 0}, Vec3(1)})})});
        EXPECT_EQ(all_hits(touching, along(x, y)).size(), 2u);
        const World pocket = world_of(
            {group(Combination::differ, {turned(whole), turned({{-0.9, -0.9, -1}, {0.9, 0.9, 0}})})});
        const auto floor = all_hits(pocket, along(x, y));
        ASSERT_EQ(floor.size(), 2u);
        EXPECT_NEAR(floor[0].t, 5 * size, 1e-9);
    }
}

TEST(Csg, ClippedShapesAreOpen) {
    Object half = solid(Sphere{});
    half.clips = {solid(Plane{{0, 1, 0}, 0})};
    const World world = world_of({half});
    const auto count = [&](Vec3 from, Vec3 way) {
        return all_hits(world, {from - world.offset, way}).size();
    };
    EXPECT_EQ(count({0.3, 5, 0}, {0, -1, 0}), 1u); // the lower half, from above: no lid
    EXPECT_EQ(count({0.3, 0.5, -5}, {0, 0, 1}), 0u);
    EXPECT_EQ(count({0.3, -0.5, -5}, {0, 0, 1}), 2u);
    EXPECT_NEAR(world.objects[1].bounds.high.y + world.offset.y, 0, 1e-9);
    EXPECT_EQ(world.objects.size(), 2u);
}

TEST(Csg, ClipsOfAUnionCutEachChild) {
    Object both = group(Combination::unite, {solid(Sphere{{-2, 0, 0}, 1}), solid(Sphere{{2, 0, 0}, 1})});
    both.clips = {solid(Plane{{0, 1, 0}, 0}), solid(Box{{-2, -9, -9}, {2, 9, 9}})};
    const World world = world_of({both});
    for (const double side : {-1.0, 1.0}) {
        EXPECT_EQ(all_hits(world, {Vec3(side * 1.5, -0.5, -5) - world.offset, {0, 0, 1}}).size(), 2u);
        EXPECT_EQ(all_hits(world, {Vec3(side * 2.5, -0.5, -5) - world.offset, {0, 0, 1}}).size(), 0u);
        EXPECT_EQ(all_hits(world, {Vec3(side * 1.5, 0.5, -5) - world.offset, {0, 0, 1}}).size(), 0u);
    }
}

TEST(Csg, UnionsInsideIntersectionsShowTheirInside) {
    const Object balls =
        group(Combination::unite, {solid(Sphere{{0, 0, -0.5}, 1}), solid(Sphere{{0, 0, 0.5}, 1})});
    const World world = world_of({group(Combination::intersect, {balls, solid(Box{Vec3(-3), Vec3(3)})})});
    EXPECT_EQ(all_hits(world, {{0, 0, -5}, {0, 0, 1}}).size(), 4u);
    Object merged = balls;
    merged.combination = Combination::merge;
    const World one = world_of({merged});
    EXPECT_EQ(all_hits(one, {{0, 0, -5}, {0, 0, 1}}).size(), 2u);
}

TEST(Csg, CutsShowTheirOwnMaterialOrTheCutOnes) {
    const auto colored = [](Object object, Color color) {
        object.texture.emplace();
        object.texture->pigment.map[0].color.rgb = color;
        return object;
    };
    Object cutter = solid(Sphere{{0, 0, -1}, 0.5});
    const auto seen = [&](const Object& object) {
        const World world = world_of({object});
        const auto hit = closest_hit(world, {Vec3(0.1, 0.1, -5) - world.offset, {0, 0, 1}}, RayKind::camera);
        return world.materials[static_cast<std::size_t>(world.surfaces[hit->surface].material)]
            .texture.pigment.map[0]
            .color.rgb;
    };
    const Object body = group(Combination::unite, {colored(solid(Box{{-1, -1, -1}, {0, 1, 1}}), {1, 0, 0}),
                                                   colored(solid(Box{{0, -1, -1}, {1, 1, 1}}), {0, 1, 0})});
    EXPECT_EQ(seen(group(Combination::differ, {body, colored(cutter, {0, 0, 1})})), Color(0, 0, 1));
    cutter.texture.reset();
    EXPECT_EQ(seen(colored(group(Combination::differ, {body, cutter}), {1, 1, 0})), Color(1, 1, 0));
    Object cutaway = group(Combination::differ, {body, cutter});
    cutaway.cutaway_textures = true;
    EXPECT_EQ(seen(cutaway), Color(0, 1, 0));
}

// ---- meshes
// -----------------------------------------------------------------------------------------------------

Mesh cube_mesh() {
    auto data = std::make_shared<MeshData>();
    for (int i = 0; i < 8; ++i) data->positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    data->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Mesh mesh;
    mesh.data = std::move(data);
    mesh.inside_vector = Vec3(0.3, 1, 0.2);
    return mesh;
}

TEST(Csg, MeshesAreSolidsAsBoxesAre) {
    const Transform turn = then(rotation({20, 30, 40}), translation({0.2, 0.1, 0}));
    const Object ball = solid(Sphere{{0.7, 0.5, -0.6}, 0.9});
    Rng rng = make_rng(6, Pass::test, 0);
    for (const Combination kind : {Combination::differ, Combination::intersect, Combination::merge})
        for (const bool first : {true, false}) {
            const auto tree = [&](const Shape& shape) {
                const Object cube = solid(shape, turn);
                return group(kind, first ? std::vector{cube, ball} : std::vector{ball, cube});
            };
            const World mesh = world_of({tree(cube_mesh())}), box = world_of({tree(Box{Vec3(-1), Vec3(1)})});
            for (int i = 0; i < 500; ++i) {
                const Ray ray = random_ray(rng);
                const auto a = all_hits(mesh, ray), b = all_hits(box, ray);
                ASSERT_EQ(a.size(), b.size()) << i;
                for (std::size_t k = 0; k < a.size(); ++k) {
                    EXPECT_NEAR(a[k].t, b[k].t, 1e-6);
                    EXPECT_LT(glm::length(a[k].normal - b[k].normal), 1e-5);
                    EXPECT_EQ(a[k].surface, b[k].surface);
                }
            }
        }
}

TEST(Csg, OpenMeshesHaveNoInside) {
    Mesh open = cube_mesh();
    open.inside_vector.reset();
    const Ray ray{{0.1, 0.2, -5}, {0, 0, 1}};
    const World cut = world_of({group(Combination::differ, {solid(Sphere{}), solid(open)})});
    EXPECT_EQ(all_hits(cut, ray).size(), 2u); // the sphere alone
    const World common = world_of(
        {group(Combination::intersect, {solid(Sphere{}), solid(open)}), solid(Box{Vec3(8), Vec3(9)})});
    EXPECT_EQ(all_hits(common, {ray.origin - common.offset, ray.direction}).size(), 0u);
}

// ---- closest points
// ---------------------------------------------------------------------------------------------------

TEST(Csg, ClosestPointsAreSeen) {
    const World world = world_of(
        {group(Combination::differ, {solid(Box{Vec3(-1), Vec3(1)}), solid(Sphere{{0, 0, -1}, 0.6})})});
    const auto index = index_surface(world, 1);
    const auto expect = [&](Vec3 query, Vec3 place, double error) {
        const ClosestPoint found = closest_point(*index, query);
        EXPECT_LT(glm::distance(found.position, place), error) << query.x << " " << query.y << " " << query.z;
    };
    expect({0, 3, 0}, {0, 1, 0}, 1e-9);
    expect({0, 0, -0.5}, {0, 0, -0.4}, 1e-9); // the floor of the pocket, not the lid that is gone
    // The rim, whose points are all almost as far.
    EXPECT_NEAR(closest_point(*index, {0.3, 0, -3}).distance, std::sqrt(0.3 * 0.3 + 4), 0.02);
    EXPECT_LT(glm::distance(closest_point(*index, {0, 0, -0.5}).normal, {0, 0, -1}),
              1e-9); // out of the solid
}

// ---- large trees
// -----------------------------------------------------------------------------------------------------

TEST(Csg, ThousandsOfHoles) {
    std::vector<Object> parts{solid(Box{Vec3(-1), Vec3(1)})};
    Rng rng = make_rng(7, Pass::test, 0);
    for (int i = 0; i < 3000; ++i) parts.push_back(solid(Sphere{random_point(rng, 1.05), 0.05}));
    const Object object = group(Combination::differ, parts);
    const World world = world_of({object});
    EXPECT_NEAR(world.radius, std::sqrt(3.0), 1e-9);
    for (int i = 0; i < 100; ++i) {
        expect_hits_of(world, object, random_ray(rng), true);
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << i;
    }
}

} // namespace
} // namespace pnr
