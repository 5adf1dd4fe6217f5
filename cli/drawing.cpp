// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/drawing.h"

#include "core/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

void blend(Image<Color>& picture, int x, int y, Color color, double share) {
    if (picture.contains(x, y))
        picture.at(x, y) = glm::mix(picture.at(x, y), color, static_cast<float>(std::clamp(share, 0.0, 1.0)));
}

// Rows from the top, three bits each.
struct Glyph {
    char letter;
    std::array<unsigned char, 5> rows;
};
constexpr Glyph glyphs[] = {{'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}},
                            {'3', {7, 1, 7, 1, 7}}, {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}},
                            {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 2, 2, 2}}, {'8', {7, 5, 7, 5, 7}},
                            {'9', {7, 5, 7, 1, 7}}, {'.', {0, 0, 0, 0, 2}}, {'-', {0, 0, 7, 0, 0}},
                            {'%', {5, 1, 2, 4, 5}}};

const Glyph* glyph_of(char letter) {
    const auto found = std::find_if(std::begin(glyphs), std::end(glyphs),
                                    [&](const Glyph& g) { return g.letter == letter; });
    return found == std::end(glyphs) ? nullptr : found;
}

} // namespace

Color displayed(float r, float g, float b) { return {srgb_decode(r), srgb_decode(g), srgb_decode(b)}; }

void draw_line(Image<Color>& picture, Vec2 from, Vec2 to, Color color) {
    const Vec2 way = to - from;
    const double length2 = glm::dot(way, way);
    const Vec2 low = glm::min(from, to) - 1.5, high = glm::max(from, to) + 1.5;
    const auto pixel = [](double v, int size) {
        return static_cast<int>(std::clamp(std::floor(v), 0.0, static_cast<double>(size)));
    };
    for (int y = pixel(low.y, picture.height); y < pixel(high.y + 1, picture.height); ++y)
        for (int x = pixel(low.x, picture.width); x < pixel(high.x + 1, picture.width); ++x) {
            const Vec2 middle(x + 0.5, y + 0.5);
            const double along =
                length2 > 0 ? std::clamp(glm::dot(middle - from, way) / length2, 0.0, 1.0) : 0;
            blend(picture, x, y, color, 1.1 - glm::distance(middle, from + along * way));
        }
}

void draw_dot(Image<Color>& picture, Vec2 middle, double radius, Color color) {
    const int reach = static_cast<int>(std::ceil(radius)) + 1;
    const int cx = static_cast<int>(std::floor(middle.x)), cy = static_cast<int>(std::floor(middle.y));
    for (int y = cy - reach; y <= cy + reach; ++y)
        for (int x = cx - reach; x <= cx + reach; ++x)
            blend(picture, x, y, color, radius + 0.5 - glm::distance(Vec2(x + 0.5, y + 0.5), middle));
}

int number_width(std::string_view text, int size) { return static_cast<int>(text.size()) * 4 * size + size; }

void draw_number(Image<Color>& picture, int x, int y, std::string_view text, int size, Color color) {
    for (int v = 0; v < 7 * size; ++v)
        for (int u = 0; u < number_width(text, size); ++u) blend(picture, x + u, y + v, Color(0), 0.75);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const Glyph* glyph = glyph_of(text[i]);
        if (!glyph) continue;
        for (int v = 0; v < 5 * size; ++v)
            for (int u = 0; u < 3 * size; ++u)
                if ((glyph->rows[static_cast<std::size_t>(v / size)] >> (2 - u / size) & 1) != 0)
                    blend(picture, x + size + static_cast<int>(i) * 4 * size + u, y + size + v, color, 1);
    }
}

Color number_color(std::uint32_t number) {
    if (number == 0) return Color(0);
    const double hue = std::fmod(number * 0.61803398874989485, 1.0) * 6;
    const double rest = number % 3 == 0 ? 0.35 : number % 3 == 1 ? 0.1 : 0.55; // how pale it is
    const auto channel = [&](double offset) {
        const double k = std::fmod(hue + offset, 6.0);
        return static_cast<float>(1 - (1 - rest) * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
    };
    return displayed(channel(5), channel(3), channel(1));
}

Color heat(double value) {
    constexpr int steps = 4;
    const std::array<Color, steps + 1> colors{Color(0, 0, 0), Color(0.15f, 0.1f, 0.6f),
                                              Color(0.8f, 0.15f, 0.3f), Color(1, 0.75f, 0.1f),
                                              Color(1, 1, 1)};
    const double place = (value > 0 ? std::min(value, 1.0) : 0) * steps; // not a number: 0
    const int step = std::min(static_cast<int>(place), steps - 1);
    const Color c = glm::mix(colors[static_cast<std::size_t>(step)],
                             colors[static_cast<std::size_t>(step) + 1], static_cast<float>(place - step));
    return displayed(c.x, c.y, c.z);
}

} // namespace pnr
