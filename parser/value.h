// SPDX-License-Identifier: GPL-3.0-or-later
// What an identifier can stand for.
#pragma once

#include "core/scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pnr {

// POV-Ray's vectors and colours are one thing in expressions: 1 to 5 numbers. A colour is <r, g, b, filter,
// transmit>.
struct VectorValue {
    double v[5] = {0, 0, 0, 0, 0};
    int size = 3;          // 1 only inside the evaluator: a scalar
    bool is_color = false; // made by a colour expression
};

struct Value;
struct ArrayValue { // fixed size, possibly nested; elements may be unset (index() == 0)
    std::vector<int> dimensions;
    std::vector<Value> elements;
};

// `color_map { [0 rgb 1] [1 rgb 0] }`, alone.
struct ColorMap {
    std::vector<ColorStop> stops;
};
// `material { texture {...} interior {...} }`
struct SaidMaterial {
    Boxed<Texture> texture, interior_texture;
    std::optional<Interior> interior;
};
// `slope_map { [0 <0, 1>] [1 <1, 1>] }`, alone.
struct SlopeMap {
    std::vector<SlopeStop> stops;
};
// A block of POV-Ray's that we know and lack (fog, media ...): it can be declared and named, and
// means nothing.
struct SkippedBlock {
    std::string word;
};

// A file that #fopen opened.
struct OpenFile {
    std::string name;
    bool writing = false;
    std::uint32_t source = 0; // of the text that is read ...
    std::size_t position = 0; // ... and the token to read next
};

struct Macro;    // expander.h
struct Function; // function.h
struct Spline;   // spline.h

// Blocks that can be declared; copied on use, heavy data (meshes) is shared inside.
using DeclaredBlock = std::variant<Object, Texture, Pigment, Finish, Interior, LightSource, Camera, Transform,
                                   PaintWord, ColorMap, BlendMap<Pigment>, Normal, SlopeMap,
                                   BlendMap<Normal>, BlendMap<Texture>, SaidMaterial, SkySphere, Fog, Rainbow,
                                   SkippedBlock>;

struct Value {
    std::variant<std::monostate, double, VectorValue, std::string, std::shared_ptr<ArrayValue>,
                 std::shared_ptr<const DeclaredBlock>, std::shared_ptr<const Macro>,
                 std::shared_ptr<const Function>, std::shared_ptr<OpenFile>, std::shared_ptr<const Spline>>
        data;
};

const char*
type_name(const Value& value); // "number", "vector", "colour", "string", "array", "object", "texture" ...

} // namespace pnr
