// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/content.h"

#include "parser/expander.h"
#include "parser/function.h"

#include <fmt/format.h>

#include <algorithm>

namespace pnr {

namespace {

void add_part(Weight& whole, const Weight& part) {
    whole.bytes += part.bytes;
    whole.depth = std::max(whole.depth, part.depth + 1);
}

// What does not count as deeper.
void add_level(Weight& whole, const Weight& part) {
    whole.bytes += part.bytes;
    whole.depth = std::max(whole.depth, part.depth);
}

template <class T>
void add_parts(Weight& whole, const std::vector<BlendEntry<T>>& entries) {
    for (const BlendEntry<T>& entry : entries) add_part(whole, weight_of(entry.value));
}

template <class T>
Weight weight_of_map(const std::vector<BlendEntry<T>>& entries) {
    Weight weight;
    add_parts(weight, entries);
    return weight;
}

Weight weight_of_layer(const TextureLayer& layer) {
    Weight weight = weight_of(layer.pigment);
    weight.bytes += sizeof(TextureLayer) - sizeof(Pigment);
    if (layer.normal) add_level(weight, weight_of(*layer.normal));
    return weight;
}

void add_objects(Weight& whole, const std::vector<Object>& objects) {
    for (const Object& object : objects) add_part(whole, weight_of(object));
}

} // namespace

Weight weight_of(const Pattern& pattern) {
    Weight weight;
    weight.bytes = pattern.warps.size() * sizeof(Warp);
    if (const auto* inner = std::get_if<PigmentPattern>(&pattern.kind))
        weight.depth = weight_of(*inner->pigment).depth + 1;
    if (const auto* inner = std::get_if<FunctionPattern>(&pattern.kind))
        if (const auto* field = inner->value.target<FunctionField>()) weight.depth = field->function->depth + 1;
    return weight;
}

Weight weight_of(const Pigment& pigment) {
    Weight weight = weight_of(pigment.pattern);
    weight.bytes += sizeof(Pigment) + pigment.map.size() * sizeof(ColorStop);
    add_parts(weight, pigment.pigments);
    return weight;
}

Weight weight_of(const Normal& normal) {
    Weight weight = weight_of(normal.pattern);
    weight.bytes += sizeof(Normal) + normal.slopes.size() * sizeof(SlopeStop);
    add_parts(weight, normal.normals);
    return weight;
}

Weight weight_of(const Texture& texture) {
    Weight weight = weight_of(texture.pattern.get());
    weight.bytes += sizeof(Texture) - sizeof(TextureLayer);
    add_level(weight, weight_of_layer(texture));
    for (const TextureLayer& layer : texture.upper) add_level(weight, weight_of_layer(layer));
    add_parts(weight, texture.textures);
    return weight;
}

Weight weight_of(const SkySphere& sky) {
    Weight weight;
    for (const Pigment& layer : sky.layers) add_part(weight, weight_of(layer));
    return weight;
}

Weight weight_of(const LightSource& light) {
    Weight weight;
    weight.bytes = sizeof(LightSource);
    add_objects(weight, light.looks_like);
    add_objects(weight, light.projected_through);
    return weight;
}

Weight weight_of_parts(const Object& object) {
    Weight weight;
    for (const auto* parts : {&object.children, &object.clips, &object.bounds}) add_objects(weight, *parts);
    for (const LightSource& light : object.lights) add_part(weight, weight_of(light));
    return weight;
}

Weight weight_of(const Object& object) {
    Weight weight = weight_of_parts(object);
    weight.bytes += sizeof(Object);
    if (object.texture) add_level(weight, weight_of(*object.texture));
    if (object.interior_texture) add_level(weight, weight_of(*object.interior_texture));
    return weight;
}

Weight weight_of(const DeclaredBlock& block) {
    Weight weight;
    if (const auto* object = std::get_if<Object>(&block)) weight = weight_of(*object);
    if (const auto* texture = std::get_if<Texture>(&block)) weight = weight_of(*texture);
    if (const auto* pigment = std::get_if<Pigment>(&block)) weight = weight_of(*pigment);
    if (const auto* normal = std::get_if<Normal>(&block)) weight = weight_of(*normal);
    if (const auto* sky = std::get_if<SkySphere>(&block)) weight = weight_of(*sky);
    if (const auto* light = std::get_if<LightSource>(&block)) weight = weight_of(*light);
    if (const auto* map = std::get_if<BlendMap<Pigment>>(&block)) weight = weight_of_map(*map);
    if (const auto* map = std::get_if<BlendMap<Normal>>(&block)) weight = weight_of_map(*map);
    if (const auto* map = std::get_if<BlendMap<Texture>>(&block)) weight = weight_of_map(*map);
    if (const auto* map = std::get_if<ColorMap>(&block)) weight.bytes = map->stops.size() * sizeof(ColorStop);
    if (const auto* material = std::get_if<SaidMaterial>(&block))
        if (material->texture) weight = weight_of(*material->texture);
    weight.bytes += sizeof(DeclaredBlock);
    return weight;
}

void check_depth(Parser& p, const Token& at, int depth) {
    const std::int64_t most = p.in.options.budgets.nesting;
    if (depth > most)
        stop_at_limit(p, at, &Budgets::nesting, fmt::format("nested deeper than {} levels", most),
                      "does a loop put it into itself again and again?");
}

void check_weight(Parser& p, const Token& at, const Weight& weight) {
    check_depth(p, at, weight.depth);
    const std::int64_t most = p.in.options.budgets.bytes;
    if (*p.in.bytes + 2 * static_cast<std::int64_t>(weight.bytes) > most) // a copy will be made
        stop_at_limit(p, at, &Budgets::bytes, fmt::format("the scene needs more than {} MB", most / 1'000'000),
                      "does a loop put it into itself again and again?");
    constexpr std::int64_t bytes_per_token = 128; // that are copied in the time of a token
    charge_work(p, at, static_cast<std::int64_t>(weight.bytes) / bytes_per_token);
}

std::shared_ptr<const DeclaredBlock> make_declared(Parser& p, const Token& at, DeclaredBlock block) {
    const Weight weight = weight_of(block);
    check_weight(p, at, weight);
    const auto bytes = static_cast<std::int64_t>(weight.bytes);
    *p.in.bytes += bytes;
    std::shared_ptr<const DeclaredBlock> declared(
        new DeclaredBlock(std::move(block)), [ledger = p.in.bytes, bytes](const DeclaredBlock* gone) {
            *ledger -= bytes;
            delete gone;
        });
    remember_told(p.in, declared.get());
    return declared;
}

} // namespace pnr
