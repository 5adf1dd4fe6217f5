// SPDX-License-Identifier: GPL-3.0-or-later
// The closed set of shapes, each in its own space, as POV-Ray defines them.
//
// To add one: create its struct, add it to `Shape`, give its bounds, its hits and its inside in shape.cpp (shape_hits.h), read it in the
// parser's table of objects, write its line into grammar/pnr.ebnf.
#pragma once

#include "core/types.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pnr {

struct Sphere {
    Vec3 center{0};
    double radius = 1;
};
struct Box {
    Vec3 low{0}, high{1};
};
struct Plane { // dot(normal, p) = distance; normal is unit; inside is the side against the normal
    Vec3 normal{0, 1, 0};
    double distance = 0;
};
struct Cylinder {
    Vec3 base{0}, cap{0, 1, 0};
    double radius = 1;
    bool open = false;
};
struct Cone {
    Vec3 base{0}, cap{0, 1, 0};
    double base_radius = 1, cap_radius = 0;
    bool open = false;
};
struct Torus { // about the y axis through the origin
    double major = 1, minor = 0.25;
};
struct Disc {
    Vec3 center{0};
    Vec3 normal{0, 1, 0}; // unit
    double radius = 1, hole = 0;
};

struct PartTextures; // scene.h: textures of a shape's own parts
inline constexpr std::uint32_t no_texture = 0xffffffffu; // a part shows the object's

// Triangles with shared vertices. `triangles` indexes positions; normals, uvs and textures (numbers of PartTextures, one
// for each corner) have their own index lists (empty: flat, no uv, the object's texture), each as long as `triangles` when
// present.
struct MeshData {
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3f> normals;
    std::vector<std::array<std::uint32_t, 3>> normal_triangles;
    std::vector<Vec2f> uvs;
    std::vector<std::array<std::uint32_t, 3>> uv_triangles;
    std::vector<std::array<std::uint32_t, 3>> texture_triangles;
    std::shared_ptr<const PartTextures> textures;
};
// triangle, mesh, mesh2, and `mesh { file }`: the file is named here and read by build_world.
struct Mesh {
    std::shared_ptr<const MeshData> data; // shared by copies; null until a file is read
    std::string file;                     // resolved path; empty if data came from the text
    bool smooth = false;                  // area-weighted vertex normals
    bool repair = false;                  // this and the next two: see work_on_mesh
    int subdivide = 0;                    // rounds
    int simplify = 0;                     // triangles to keep; 0: all
    std::optional<Vec3> inside_vector;    // said: the mesh is a solid; inside is decided along this direction
    SourceRef said_at;
};
// points[row * 4 + column]; flattened to triangles by u_steps and v_steps, smooth normals. The outside is the side of
// cross(along a row, from row to row).
struct BicubicPatch {
    std::vector<Vec3> points = std::vector<Vec3>(16); // not an array: all shapes would be as large as the largest
    int u_steps = 4, v_steps = 4; // as POV-Ray: the patch is cut into 2^u_steps by 2^v_steps
    double flatness = 0;
    // Texture coordinates of the corners points[0], [3], [15] and [12]; between them they are mixed.
    std::vector<Vec2> corner_uv{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
};

// Shapes that are given by fields (shape_field.h). What was said is shared by copies; what build_world makes of it, see
// prepare_field_shape, is null until then.
struct IsosurfaceData;
struct IsosurfaceCells;
struct Isosurface {
    std::shared_ptr<const IsosurfaceData> data;
    std::shared_ptr<const IsosurfaceCells> cells;
};
struct BlobData;
struct Blob {
    std::shared_ptr<const BlobData> data;
    std::shared_ptr<const PartTextures> textures; // of components; null: none has its own
};
struct HeightFieldData;
struct HeightGrid;
struct HeightField {
    std::shared_ptr<const HeightFieldData> data;
    std::shared_ptr<const HeightGrid> grid;
};
struct JuliaFractalData;
struct JuliaFractal {
    std::shared_ptr<const JuliaFractalData> data;
};
struct ParametricData;
struct Parametric { // becomes a mesh: see tessellate
    std::shared_ptr<const ParametricData> data;
};

// Shapes that are given by polynomials and the like (shape_algebraic.h). What has many numbers is shared by copies.
struct Quadric { // inside where q[0] x^2 + q[1] y^2 + q[2] z^2 + q[3] xy + q[4] xz + q[5] yz + q[6] x + q[7] y + q[8] z + q[9] < 0
    std::array<double, 10> q{};
};
struct PolynomialData;
struct PolynomialSurface { // cubic, quartic, poly; inside where negative
    std::shared_ptr<const PolynomialData> data;
};
struct Superellipsoid { // (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1
    double east_west = 1, north_south = 1;
};
struct Ovus { // an egg: a ball of radius `bottom` about the origin, one of radius `top` about <0, bottom, 0>, and their hull
    double bottom = 1, top = 0.5;
};

// Shapes that are made of curves (shape_swept.h).
struct LatheData;
struct Lathe { // about the y axis
    std::shared_ptr<const LatheData> data;
};
struct Sor { // likewise
    std::shared_ptr<const LatheData> data;
    bool open = false; // without lids
};
struct PrismData;
struct Prism { // along y
    std::shared_ptr<const PrismData> data;
    bool open = false; // without lids
};
struct SphereSweepData;
struct SphereSweep {
    std::shared_ptr<const SphereSweepData> data;
};
struct PolygonData;
struct Polygon {
    std::shared_ptr<const PolygonData> data;
};
struct TextData;
struct Text { // from z = 0 on
    std::shared_ptr<const TextData> data;
};

using Shape = std::variant<Sphere, Box, Plane, Cylinder, Cone, Torus, Disc, Mesh, BicubicPatch, Isosurface, Blob,
                           HeightField, JuliaFractal, Parametric, Quadric, PolynomialSurface, Superellipsoid, Ovus, Lathe,
                           Sor, Prism, SphereSweep, Polygon, Text>;

// In the shape's own space; infinite for unbounded shapes.
Bounds shape_bounds(const Shape& shape);
// Whether what was said of it is finite: those that are shared were checked when they were read.
bool has_finite_numbers(const Shape& shape);
const char* shape_name(const Shape& shape); // POV-Ray's word

} // namespace pnr
