// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/block_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace pnr {
namespace {

bool offers(const std::vector<std::string_view>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

TEST(BlockWords, AreTheItemsOfTheBlockAlone) {
    struct Case {
        const char* block;
        std::vector<const char*> in, out;
    };
    const Case cases[] = {
        {"sphere",
         {"pigment", "npr", "translate", "no_shadow"},
         {"sphere", "seeds", "fresnel", "location", "sin"}},
        {"npr", {"style", "seeds", "field", "ilic", "mix"}, {"seed", "cell", "pigment"}},
        {"seeds", {"seed", "rbf"}, {"kernel", "npr"}},
        {"ilic", {"length", "cell", "noise", "gaussian", "layer"}, {"bare", "radius"}},
        {"layer", {"opacity", "bare", "cell"}, {"gaussian"}},
        {"finish", {"diffuse", "reflection", "irid"}, {"fresnel", "thickness"}},
        {"reflection", {"fresnel", "falloff"}, {"diffuse"}},
        {"camera", {"location", "angle", "perspective"}, {"pigment"}},
        {"light_source", {"emitter", "power", "spotlight", "area_light", "translate"}, {"rectangle"}},
        {"emitter", {"sphere", "rectangle"}, {"power"}},
        {"union", {"sphere", "npr", "light_source"}, {"camera", "global_lights"}},
        {"light_group", {"global_lights", "box"}, {"camera"}},
        {"global_settings", {"photons", "view", "radiosity"}, {"gather", "sphere"}},
        {"photons", {"count", "gather", "specular_probability"}, {"view"}},
        {"pigment", {"checker", "gradient", "color_map", "turbulence", "scale"}, {"diffuse"}},
        {"transform", {"rotate", "matrix", "inverse"}, {"pigment"}},
        {"", {"camera", "sphere", "union", "global_settings"}, {"translate", "pigment", "location"}},
    };
    for (const Case& c : cases) {
        const auto words = block_words(c.block);
        for (const char* word : c.in) EXPECT_TRUE(offers(words, word)) << word << " in " << c.block;
        for (const char* word : c.out) EXPECT_FALSE(offers(words, word)) << word << " in " << c.block;
    }
    for (const char* word : {"no_such_block", "no_shadow", "inverse", "ior", "rgb"})
        EXPECT_TRUE(block_words(word).empty()) << word;
}

TEST(BlockWords, ValuesAndDirectivesHaveTheirOwnLists) {
    for (const char* word : {"vrotate", "sin", "rgb", "transmit", "pi", "concat"})
        EXPECT_TRUE(offers(value_words(), word)) << word;
    EXPECT_FALSE(offers(value_words(), "sphere"));
    for (const char* word : {"declare", "include", "for", "end", "case", "fopen"})
        EXPECT_TRUE(offers(directive_words(), word)) << word;
    EXPECT_FALSE(offers(directive_words(), "sphere"));
}

} // namespace
} // namespace pnr
