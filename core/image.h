// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in memory: rows from the top, pixel (0, 0) top left, its centre at (0.5, 0.5).
#pragma once

#include "core/types.h"

#include <cstddef>
#include <vector>

namespace pnr {

template <class T>
struct Image {
    int width = 0;
    int height = 0;
    std::vector<T> pixels; // row by row, width * height of them

    Image() = default;
    Image(int w, int h, T value = T{})
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}

    T& at(int x, int y) { return pixels[index(x, y)]; }
    const T& at(int x, int y) const { return pixels[index(x, y)]; }
    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    bool empty() const { return pixels.empty(); }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

// Half-open pixel rectangle: x0 <= x < x1, y0 <= y < y1.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool contains(int x, int y) const { return x >= x0 && y >= y0 && x < x1 && y < y1; }
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};
// A rectangle grown by `apron` pixels on each side, inside a picture of width x height.
PixelRect grow(PixelRect rect, int apron, int width, int height);

// What a pass contributes to the picture. Colours are radiance, premultiplied by the share of the pixel (and,
// seen through mirrors or glass, by the chain's weight) that they stand for; alpha is that share's mean over
// RGB.
struct Layer {
    Image<Color> color;
    Image<float> alpha;
};

// The picture: each pass has left out what the other one gives, so premultiplied layers add up.
// Throws std::invalid_argument if their sizes differ; an empty layer counts as black.
Image<Color> over(const Layer& painted, const Layer& photoreal);

} // namespace pnr
