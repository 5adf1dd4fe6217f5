// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/png_file.h"

#include "core/parallel.h"

#include <zlib.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <span>
#include <stdexcept>
#include <string_view>

namespace pnr {

namespace {

using Bytes = std::vector<unsigned char>;

void append_big_endian(Bytes& to, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<unsigned char>(value >> shift));
}

void append_chunk(Bytes& file, std::string_view kind, std::span<const unsigned char> data) {
    append_big_endian(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = file.size();
    file.insert(file.end(), kind.begin(), kind.end());
    file.insert(file.end(), data.begin(), data.end());
    append_big_endian(file, static_cast<std::uint32_t>(
                                ::crc32(0, file.data() + begin, static_cast<uInt>(file.size() - begin))));
}

int paeth(int a, int b, int c) {
    const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

// What a filter (1 left, 2 above, 3 their mean, 4 Paeth's choice) foretells a byte to be.
int foretold(int filter, int a, int b, int c) {
    switch (filter) {
    case 1:
        return a;
    case 2:
        return b;
    case 3:
        return (a + b) / 2;
    case 4:
        return paeth(a, b, c);
    default:
        return 0;
    }
}

// One row through one filter; the sum of the differences' sizes says how well it will pack (the
// specification's advice).
long filter_row(int filter, const std::uint8_t* row, const std::uint8_t* above, std::size_t stride,
                std::size_t pixel, unsigned char* out) {
    long sum = 0;
    out[0] = static_cast<unsigned char>(filter);
    for (std::size_t i = 0; i < stride; ++i) {
        const int a = i >= pixel ? row[i - pixel] : 0, b = above ? above[i] : 0,
                  c = above && i >= pixel ? above[i - pixel] : 0;
        out[i + 1] = static_cast<unsigned char>(row[i] - foretold(filter, a, b, c));
        sum += std::abs(static_cast<int>(static_cast<signed char>(out[i + 1])));
    }
    return sum;
}

Bytes filtered(const BytePicture& picture) {
    const auto pixel = static_cast<std::size_t>(picture.channels);
    const std::size_t stride = static_cast<std::size_t>(picture.width) * pixel;
    Bytes rows((stride + 1) * static_cast<std::size_t>(picture.height));
    parallel_for(picture.height, 16, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        Bytes trial(stride + 1);
        for (auto y = static_cast<std::size_t>(begin); y < static_cast<std::size_t>(end); ++y) {
            const std::uint8_t* row = picture.bytes.data() + y * stride;
            long best = std::numeric_limits<long>::max();
            for (int filter = 0; filter < 5; ++filter) {
                const long sum =
                    filter_row(filter, row, y > 0 ? row - stride : nullptr, stride, pixel, trial.data());
                if (sum >= best) continue;
                best = sum;
                std::copy(trial.begin(), trial.end(),
                          rows.begin() + static_cast<std::ptrdiff_t>(y * (stride + 1)));
            }
        }
    });
    return rows;
}

Bytes packed(const Bytes& rows) {
    z_stream stream{};
    if (::deflateInit(&stream, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
    Bytes all;
    std::array<unsigned char, 1 << 16> buffer{};
    std::size_t taken = 0;
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        constexpr std::size_t piece = std::size_t{1} << 30; // zlib counts in 32 bits
        if (stream.avail_in == 0 && taken < rows.size()) {
            const std::size_t next = std::min(piece, rows.size() - taken);
            stream.next_in = const_cast<unsigned char*>(rows.data() + taken);
            stream.avail_in = static_cast<uInt>(next);
            taken += next;
        }
        stream.next_out = buffer.data();
        stream.avail_out = static_cast<uInt>(buffer.size());
        state = ::deflate(&stream, taken == rows.size() ? Z_FINISH : Z_NO_FLUSH);
        all.insert(all.end(), buffer.data(), buffer.data() + (buffer.size() - stream.avail_out));
    }
    ::deflateEnd(&stream);
    return all;
}

// Texts are Latin-1 without a zero or a line that never ends; names have at most 79 letters.
void append_texts(Bytes& file, const Metadata& metadata) {
    for (const auto& [name, value] : metadata) {
        const auto* text = std::get_if<std::string>(&value);
        const std::string said = text ? *text : std::to_string(std::get<float>(value));
        Bytes data;
        for (const char c : name.substr(0, 79)) data.push_back(static_cast<unsigned char>(c));
        data.push_back(0);
        for (const char c : said)
            if (c != '\0') data.push_back(static_cast<unsigned char>(c));
        append_chunk(file, "tEXt", data);
    }
}

} // namespace

std::vector<unsigned char> png_bytes(const BytePicture& picture) {
    const std::size_t pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    if (picture.width < 1 || picture.height < 1 || (picture.channels != 3 && picture.channels != 4) ||
        picture.bytes.size() != pixels * static_cast<std::size_t>(picture.channels))
        throw std::invalid_argument("png_bytes: the bytes do not fill the picture");
    constexpr std::array<unsigned char, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes file(signature.begin(), signature.end());
    Bytes header;
    append_big_endian(header, static_cast<std::uint32_t>(picture.width));
    append_big_endian(header, static_cast<std::uint32_t>(picture.height));
    const unsigned char color = picture.channels == 4 ? 6 : 2;
    header.insert(header.end(), {8, color, 0, 0, 0}); // 8 bits, deflate, the five filters, not interlaced
    append_chunk(file, "IHDR", header);
    append_chunk(file, "sRGB", std::array<unsigned char, 1>{0}); // perceptual
    Bytes gamma;
    append_big_endian(gamma, 45455); // for readers that do not know sRGB
    append_chunk(file, "gAMA", gamma);
    append_texts(file, picture.metadata);
    const Bytes data = packed(filtered(picture));
    constexpr std::size_t largest = std::size_t{1} << 30; // a chunk's length has 31 bits
    for (std::size_t at = 0; at < data.size(); at += largest)
        append_chunk(file, "IDAT", std::span(data).subspan(at, std::min(largest, data.size() - at)));
    append_chunk(file, "IEND", {});
    return file;
}

} // namespace pnr
