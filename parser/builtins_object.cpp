// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that ask something of a declared object. Its geometry is built once, however often it is
// asked.
#include "core/probe.h"
#include "core/shape_field.h"
#include "parser/builtins.h"
#include "parser/expander.h"

#include <fmt/format.h>

#include <algorithm>

namespace pnr {

namespace {

using Declared = std::shared_ptr<const DeclaredBlock>;

Declared object_argument(Parser& p, const Token& name) {
    const Token token = peek(p);
    const Value* value = token.kind == TokenKind::word ? lookup(p.in, token.symbol) : nullptr;
    if (!value)
        fail(p, token,
             fmt::format("{} needs a declared object, found {}", token_text(p, name, false),
                         token_text(p, token)));
    const Value taken = take_variable(p);
    const auto* block = std::get_if<Declared>(&taken.data);
    if (!block || !std::holds_alternative<Object>(**block))
        fail(p, token,
             fmt::format("{} needs an object, this is {}", token_text(p, name, false), article_name(taken)));
    return *block;
}

const Probe& probe_of(Parser& p, const Token& name, const Declared& object) {
    auto& probe = p.probes[object];
    if (probe) return *probe;
    try {
        probe = make_probe(std::get<Object>(*object));
    } catch (const std::runtime_error& problem) { // SceneError, FileError
        fail(p, name, fmt::format("this object cannot be built: {}", problem.what()));
    }
    return *probe;
}

Vec3 point_argument(Parser& p, const Token& name) {
    comma_argument(p, name);
    const VectorValue v = vector_argument(p);
    return {v.v[0], v.v[1], v.v[2]};
}

VectorValue vector_of(Vec3 v) { return {{v.x, v.y, v.z, 0, 0}, 3, false}; }

// How long a ray takes, in tokens; more where numbers are searched for.
std::int64_t ray_work(const Object& object) {
    std::int64_t work = 50;
    if (object.shape) {
        if (const auto* julia = std::get_if<JuliaFractal>(&*object.shape)) work += 400 * julia->data->max_iteration;
        if (std::holds_alternative<Isosurface>(*object.shape)) work += 500;
    }
    for (const Object& child : object.children) work = std::max(work, ray_work(child)); // most boxes are missed
    return work;
}

// trace(object, from, direction [, normal]): the place of the first hit; the variable `normal` becomes the
// normal there, or zero where nothing is hit.
VectorValue trace_object(Parser& p, const Token& name, const Declared& object) {
    const Vec3 from = point_argument(p, name), direction = point_argument(p, name);
    const Probe& probe = probe_of(p, name, object);
    charge_work(p, name, ray_work(std::get<Object>(*object)));
    const auto hit = trace(probe, from, direction);
    if (accept(p, ',')) {
        const Token variable = peek(p);
        const Value* value = variable.kind == TokenKind::word ? lookup(p.in, variable.symbol) : nullptr;
        if (!value || !std::holds_alternative<VectorValue>(value->data))
            fail(p, variable, "trace needs a declared vector for the normal",
                 "declare it first: #declare Normal = <0, 0, 0>;");
        next(p);
        assign(p, variable.symbol, Value{vector_of(hit ? hit->normal : Vec3(0))}, false);
    }
    return vector_of(hit ? hit->position : Vec3(0));
}

} // namespace

bool is_object_function(Keyword word) {
    return word == "inside"_kw || word == "trace"_kw || word == "min_extent"_kw || word == "max_extent"_kw;
}

VectorValue object_function(Parser& p, const Token& name) {
    const auto word = static_cast<Keyword>(name.symbol);
    const Declared object = object_argument(p, name);
    if (word == "trace"_kw) return trace_object(p, name, object);
    if (word == "inside"_kw) {
        const Vec3 point = point_argument(p, name);
        VectorValue is{{0, 0, 0, 0, 0}, 1, false};
        is.v[0] = is_inside(probe_of(p, name, object), point);
        return is;
    }
    constexpr double far = 1e10; // POV-Ray's end of the endless
    auto& known = p.extents[object];
    if (!known) known = object_bounds(std::get<Object>(*object));
    const Bounds box = *known;
    if (is_empty(box)) return vector_of(Vec3(0));
    return vector_of(glm::clamp(word == "min_extent"_kw ? box.low : box.high, Vec3(-far), Vec3(far)));
}

} // namespace pnr
