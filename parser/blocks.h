// SPDX-License-Identifier: GPL-3.0-or-later
// The scene's blocks. Functions return by value what was said; transforms inside a block are applied to what stands
// before them.
#pragma once

#include "parser/parser.h"

#include <optional>

namespace pnr {

// A scene file: items until the end of input, into p.scene and p.settings. Errors are recorded in the diagnostics.
void parse_scene(Parser& p);

// If the next token starts a block that can be declared (object, texture, pigment, finish, interior, light_source,
// camera, transform, npr, style ...), parses it. Called by parse_value for #declare.
std::optional<DeclaredBlock> parse_declared_block(Parser& p);
// The block of `#default { ... }`, behind its `{` and up to its `}`.
void parse_default_block(Parser& p);

std::optional<Object> parse_object(Parser& p); // nothing if no object statement stands here
LightSource parse_light_source(Parser& p);
Camera parse_camera(Parser& p);
Texture parse_texture(Parser& p, const Texture& start);
Pigment parse_pigment(Parser& p, const Pigment& start);
Finish parse_finish(Parser& p, const Finish& start);
Interior parse_interior(Parser& p, const Interior& start);
PaintWord parse_npr(Parser& p);
Transform parse_transform_block(Parser& p);
bool accept_transform(Parser& p, Transform& transform); // translate, rotate, scale, matrix, transform: one of them
void parse_global_settings(Parser& p);

} // namespace pnr
