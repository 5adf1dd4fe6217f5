// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/palette_picture.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>

namespace pnr {

namespace {

constexpr std::size_t most_pixels = std::size_t{1} << 29;

// Bytes of a file; reading beyond the end gives 0 and is remembered.
struct Bytes {
    const std::vector<unsigned char>& data;
    std::size_t at = 0;
    bool ended = false;

    std::uint32_t byte() { return at < data.size() ? data[at++] : (ended = true, 0); }
    std::uint32_t big_endian() {
        std::uint32_t v = 0;
        for (int i = 0; i < 4; ++i) v = v << 8 | byte();
        return v;
    }
    std::uint32_t little_endian_16() {
        const std::uint32_t low = byte();
        return low | byte() << 8;
    }
};

// ---- PNG

int paeth(int a, int b, int c) {
    const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

// Pixels of a byte or less: the pixel to the left is the byte to the left.
bool unfilter(std::vector<unsigned char>& rows, std::size_t stride, std::size_t count) {
    for (std::size_t y = 0; y < count; ++y) {
        unsigned char* row = rows.data() + y * (stride + 1);
        const unsigned char* above = y > 0 ? row - stride - 1 : nullptr;
        const int filter = row[0];
        if (filter > 4) return false;
        for (std::size_t i = 1; i <= stride; ++i) {
            const int a = i > 1 ? row[i - 1] : 0, b = above ? above[i] : 0,
                      c = above && i > 1 ? above[i - 1] : 0;
            const int guess[5] = {0, a, b, (a + b) / 2, paeth(a, b, c)};
            row[i] = static_cast<unsigned char>(row[i] + guess[filter]);
        }
    }
    return true;
}

std::optional<Image<std::uint8_t>> read_png(Bytes in) {
    in.at = 8;
    std::vector<unsigned char> packed;
    std::size_t width = 0, height = 0;
    std::uint32_t depth = 0;
    while (!in.ended && in.at < in.data.size()) {
        const std::size_t length = in.big_endian(), start = in.at + 4;
        if (start + length > in.data.size()) return std::nullopt;
        const std::string_view kind(reinterpret_cast<const char*>(in.data.data()) + in.at, 4);
        in.at = start;
        if (kind == "IHDR") {
            width = in.big_endian(), height = in.big_endian();
            depth = in.byte();
            const std::uint32_t color = in.byte();
            in.at += 2;
            if (color != 3 || depth > 8 || in.byte() != 0) return std::nullopt;
        } else if (kind == "IDAT") {
            packed.insert(packed.end(), in.data.begin() + static_cast<std::ptrdiff_t>(start),
                          in.data.begin() + static_cast<std::ptrdiff_t>(start + length));
        }
        in.at = start + length + 4;
    }
    if (width == 0 || height == 0 || depth == 0 || width > most_pixels / height) return std::nullopt;
    const std::size_t stride = (width * depth + 7) / 8;
    std::vector<unsigned char> rows((stride + 1) * height);
    uLongf size = rows.size();
    if (uncompress(rows.data(), &size, packed.data(), packed.size()) != Z_OK || size != rows.size())
        return std::nullopt;
    if (!unfilter(rows, stride, height)) return std::nullopt;
    Image<std::uint8_t> numbers(static_cast<int>(width), static_cast<int>(height));
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint32_t byte = rows[y * (stride + 1) + 1 + x * depth / 8];
            const std::uint32_t shift = 8 - depth - static_cast<std::uint32_t>(x * depth % 8);
            numbers.pixels[y * width + x] = static_cast<std::uint8_t>(byte >> shift & ((1u << depth) - 1));
        }
    return numbers;
}

// ---- GIF

// Codes of growing width, packed from the low bits on, in blocks of up to 255 bytes.
struct CodeReader {
    Bytes& in;
    std::uint32_t left_in_block = 0, bits = 0;
    int count = 0;

    int next(int width) {
        while (count < width) {
            if (left_in_block == 0 && (left_in_block = in.byte()) == 0) return -1;
            bits |= in.byte() << count;
            count += 8, --left_in_block;
            if (in.ended) return -1;
        }
        const int code = static_cast<int>(bits & ((1u << width) - 1));
        bits >>= width, count -= width;
        return code;
    }
};

// Lempel, Ziv and Welch's code: an entry is an earlier one and a byte more.
bool unpack_gif(Bytes& in, std::vector<std::uint8_t>& pixels) {
    const int root_width = static_cast<int>(in.byte());
    if (root_width < 1 || root_width > 11) return false;
    const int clear = 1 << root_width, end = clear + 1;
    std::array<int, 4096> earlier{};
    std::array<std::uint8_t, 4096> last{};
    for (int i = 0; i < clear; ++i)
        earlier[static_cast<std::size_t>(i)] = -1,
        last[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i);
    CodeReader codes{in};
    int width = root_width + 1, size = end + 1, previous = -1;
    std::vector<std::uint8_t> text;
    std::size_t filled = 0;
    while (filled < pixels.size()) {
        const int code = codes.next(width);
        if (code < 0 || code == end) break;
        if (code == clear) {
            width = root_width + 1, size = end + 1, previous = -1;
            continue;
        }
        if (code > size || (code == size && previous < 0)) return false;
        text.clear();
        for (int c = code == size ? previous : code; c >= 0; c = earlier[static_cast<std::size_t>(c)])
            text.push_back(last[static_cast<std::size_t>(c)]);
        std::reverse(text.begin(), text.end());
        if (code == size) text.push_back(text.front());
        if (previous >= 0 && size < 4096) {
            earlier[static_cast<std::size_t>(size)] = previous,
            last[static_cast<std::size_t>(size)] = text.front();
            if (++size == 1 << width && width < 12) ++width;
        }
        previous = code;
        for (const std::uint8_t c : text)
            if (filled < pixels.size()) pixels[filled++] = c;
    }
    return filled > 0;
}

std::optional<Image<std::uint8_t>> read_gif(Bytes in) {
    in.at = 10;
    const std::uint32_t flags = in.byte();
    in.at = 13 + (flags & 0x80 ? 3u << ((flags & 7) + 1) : 0);
    for (;;) {
        const std::uint32_t kind = in.byte();
        if (kind == 0x21) { // an extension: skipped
            in.byte();
            for (std::uint32_t length = in.byte(); length != 0 && !in.ended; length = in.byte())
                in.at += length;
            continue;
        }
        if (kind != 0x2c || in.ended) return std::nullopt;
        in.at += 4;
        const std::size_t width = in.little_endian_16(), height = in.little_endian_16();
        const std::uint32_t local = in.byte();
        if (local & 0x80) in.at += 3u << ((local & 7) + 1);
        if (width == 0 || height == 0) return std::nullopt;
        Image<std::uint8_t> stored(static_cast<int>(width), static_cast<int>(height));
        if (!unpack_gif(in, stored.pixels)) return std::nullopt;
        if (!(local & 0x40)) return stored;
        Image<std::uint8_t> numbers(stored.width, stored.height); // interlaced: rows in four passes
        int from = 0;
        for (const auto& [first, step] : {std::pair{0, 8}, {4, 8}, {2, 4}, {1, 2}})
            for (int y = first; y < stored.height; y += step, ++from)
                for (int x = 0; x < stored.width; ++x) numbers.at(x, y) = stored.at(x, from);
        return numbers;
    }
}

} // namespace

std::optional<Image<std::uint8_t>> read_palette_numbers(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<unsigned char> data{std::istreambuf_iterator<char>(file),
                                          std::istreambuf_iterator<char>()};
    const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
    if (text.starts_with("\x89PNG\r\n\x1a\n")) return read_png({data});
    if (text.starts_with("GIF8")) return read_gif({data});
    return std::nullopt;
}

} // namespace pnr
