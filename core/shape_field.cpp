// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_field.h"

namespace pnr {

Shape prepare_field_shape(const Shape& shape) {
    if (const auto* s = std::get_if<Isosurface>(&shape)) return prepare_isosurface(*s);
    if (const auto* s = std::get_if<HeightField>(&shape)) return prepare_height_field(*s);
    return shape;
}

} // namespace pnr
