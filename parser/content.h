// SPDX-License-Identifier: GPL-3.0-or-later
// What a value that holds others of its kind weighs: pigments in pigments, textures in textures, objects in groups. A few
// lines that double a declared texture again and again would fill the machine, and the recursion over one that is nested
// a hundred thousand deep its stack; both end at a budget.
#pragma once

#include "parser/parser.h"

namespace pnr {

struct Weight {
    std::size_t bytes = 0; // also of what copies share
    int depth = 0;         // of others inside
};
Weight weight_of(const Pattern& pattern); // but for its own size
Weight weight_of(const Pigment& pigment);
Weight weight_of(const Normal& normal);
Weight weight_of(const Texture& texture);
Weight weight_of(const SkySphere& sky);
Weight weight_of(const LightSource& light);
Weight weight_of(const Object& object);
Weight weight_of_parts(const Object& object); // its children, lights and limits
Weight weight_of(const DeclaredBlock& block);

// Stops at the budgets if it is too deep or more than the memory that is left, and counts the work of copying it.
void check_weight(Parser& p, const Token& at, const Weight& weight);
void check_depth(Parser& p, const Token& at, int depth);

// The value of a #declare; its memory counts until it is freed.
std::shared_ptr<const DeclaredBlock> make_declared(Parser& p, const Token& at, DeclaredBlock block);

} // namespace pnr
