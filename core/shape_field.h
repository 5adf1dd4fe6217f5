// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that are given by fields: what is said of them, and what the rays ask. Each in its own space, as
// POV-Ray defines them.
#pragma once

#include "core/field_program.h"
#include "core/scalar_field.h"
#include "core/shape_hits.h"

namespace pnr {

// Where a field is below a threshold, inside a sphere or a box.
struct IsosurfaceData {
    FieldProgram field;
    double threshold = 0;
    bool in_sphere = false; // else in the box
    Sphere sphere;
    Box box{Vec3(-1), Vec3(1)};
    bool open = false; // the container's surface is not there
    double accuracy = 0.001;
    double max_gradient = 1.1; // of the field; believed where the field cannot be enclosed in intervals
};
// The cells of a grid over the container where the field may cross the threshold, for a ray to walk through.
struct IsosurfaceCells {
    static constexpr int size = 32;
    Vec3 low{0}, step{1};
    std::vector<std::uint32_t> rows; // a bit for each x, from 0; rows[z * size + y]
    Bounds bounds;                   // of the surface, lids included
    double gradient = 0;             // as max_gradient, at least what was met
};

// density(p) = sum of strength (1 - d^2 / r^2)^2 over the components whose influence reaches p; inside: >
// threshold.
struct BlobComponent {
    enum class Kind : std::uint8_t { sphere, cylinder } kind = Kind::sphere;
    Transform transform;  // the component's own space -> the blob's
    Vec3 base{0}, cap{0}; // of the axis; a sphere's centre is its base
    double radius = 1, strength = 1;
    std::uint32_t texture = no_texture; // into the blob's PartTextures
};
struct BlobData {
    static constexpr std::uint32_t no_component = 0xffffffffu;
    struct Node { // boxes over the components, depth first: `skip` is the next one outside this box
        Bounds box;
        std::uint32_t component = no_component;
        std::uint32_t skip = 0;
    };
    std::vector<BlobComponent> components;
    double threshold = 1;
    std::vector<Node> nodes; // see finish_blob
};
// Fills `nodes`.
void finish_blob(BlobData& blob);
double blob_density(const BlobData& blob, Vec3 p);
// What the components of each texture add to the density at p: the largest three, others left out; unused ones are 0.
struct BlobShare {
    std::uint32_t texture = no_texture;
    double share = 0;
};
using BlobShares = std::array<BlobShare, 3>;
BlobShares blob_shares(const BlobData& blob, Vec3 p);

// Heights over the unit square, as a sheet of triangles between the points of a grid.
struct HeightFieldData {
    std::string file;     // resolved; empty: the function
    bool pot = false;     // a GIF whose right half holds the low bytes
    ScalarField function; // of x, y in [0, 1]
    int width = 0, height = 0;
    bool smooth = false;
    double water_level = 0;
    SourceRef said_at;
};
struct HeightGrid {
    int width = 0, height = 0;  // points
    std::vector<float> heights; // rows from z = 0, in [0, 1]
    // Lowest and highest over squares of 2, 4, 8 ... cells, the finest first.
    struct Level {
        int width = 0, height = 0;
        std::vector<std::array<float, 2>> ends;
    };
    std::vector<Level> levels;
};

// Julia sets in four dimensions: those points of the cut whose orbit stays bounded.
struct JuliaFractalData {
    enum class Algebra : std::uint8_t { quaternion, hypercomplex } algebra = Algebra::quaternion;
    enum class Map : std::uint8_t {
        square,
        cube,
        exp,
        reciprocal,
        sin,
        asin,
        sinh,
        asinh,
        cos,
        acos,
        cosh,
        acosh,
        tan,
        atan,
        tanh,
        atanh,
        ln,
        power,
    } map = Map::square;
    double parameter[4] = {1, 0, 0, 0}; // POV-Ray's default
    double power[2] = {0, 0};
    int max_iteration = 20;
    double precision = 20;
    double slice[4] = {0, 0, 0, 1}, slice_distance = 0; // the cut: dot(q, slice) = distance
};

struct ParametricData {
    FieldProgram x, y, z; // of u, v
    Vec2 low{0}, high{1};
    bool in_sphere = false;
    Sphere sphere;
    Box box{Vec3(-1), Vec3(1)};
    double accuracy = 0.001;
};

// What build_world must make before rays can meet the shape: cells of an isosurface, heights. Others come
// back as they are. Throws FileError and SceneError as build_world does.
Shape prepare_field_shape(const Shape& shape);
Isosurface prepare_isosurface(const Isosurface& shape);
HeightField prepare_height_field(const HeightField& shape);
MeshData tessellate(const Parametric& shape);

Bounds bounds_of(const Isosurface& shape);
Bounds bounds_of(const Blob& shape);
Bounds bounds_of(const HeightField& shape);
Bounds bounds_of(const JuliaFractal& shape);
Bounds bounds_of(const Parametric& shape);

// As intersect_shape and inside_shape.
void intersect(const Isosurface& shape, const Ray& ray, HitList& hits, int enough);
void intersect(const Blob& shape, const Ray& ray, HitList& hits, int enough);
void intersect(const HeightField& shape, const Ray& ray, HitList& hits, int enough);
void intersect(const JuliaFractal& shape, const Ray& ray, HitList& hits, int enough);
bool is_inside(const Isosurface& shape, Vec3 p);
bool is_inside(const Blob& shape, Vec3 p);
bool is_inside(const HeightField& shape, Vec3 p);
bool is_inside(const JuliaFractal& shape, Vec3 p);

} // namespace pnr
