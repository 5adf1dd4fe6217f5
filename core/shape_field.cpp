// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_field.h"

namespace pnr {

Shape prepare_field_shape(const Shape& shape) { return shape; }
MeshData tessellate(const Parametric&) { return {}; }
Bounds bounds_of(const Isosurface&) { return {}; }
Bounds bounds_of(const Blob&) { return {}; }
Bounds bounds_of(const HeightField&) { return {}; }
Bounds bounds_of(const JuliaFractal&) { return {}; }
Bounds bounds_of(const Parametric&) { return {}; }
void intersect(const Isosurface&, const Ray&, HitList&, int) {}
void intersect(const Blob&, const Ray&, HitList&, int) {}
void intersect(const HeightField&, const Ray&, HitList&, int) {}
void intersect(const JuliaFractal&, const Ray&, HitList&, int) {}
bool is_inside(const Isosurface&, Vec3) { return false; }
bool is_inside(const Blob&, Vec3) { return false; }
bool is_inside(const HeightField&, Vec3) { return false; }
bool is_inside(const JuliaFractal&, Vec3) { return false; }

} // namespace pnr
