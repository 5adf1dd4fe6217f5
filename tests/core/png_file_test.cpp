// SPDX-License-Identifier: GPL-3.0-or-later
// Our PNG files, read by the image library.
#include "core/png_file.h"

#include "core/rng.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pnr {
namespace {

namespace fs = std::filesystem;

Image<glm::vec4> read_back(const BytePicture& picture) {
    const fs::path file = fs::temp_directory_path() / ("pnr-png-" + std::to_string(::getpid()) + ".png");
    const std::vector<unsigned char> bytes = png_bytes(picture);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    Image<glm::vec4> read = read_image(file);
    fs::remove(file);
    return read;
}

void expect_same(const BytePicture& picture) {
    const Image<glm::vec4> read = read_back(picture);
    ASSERT_EQ(read.width, picture.width);
    ASSERT_EQ(read.height, picture.height);
    const auto channels = static_cast<std::size_t>(picture.channels);
    for (std::size_t i = 0; i < read.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            ASSERT_EQ(std::lround(255 * srgb_encode(read.pixels[i][c])),
                      picture.bytes[i * channels + static_cast<std::size_t>(c)])
                << i;
        if (channels == 4) {
            ASSERT_EQ(std::lround(255 * read.pixels[i].w), picture.bytes[i * channels + 3]) << i;
        }
    }
}

// Rows that each filter packs best: noise, flat, slopes across, down and both ways.
BytePicture picture_of(int width, int height, int channels) {
    BytePicture picture{width, height, channels, {}, {{"Software", "pnr"}}};
    Rng rng = make_rng(3, Pass::test, 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                const int kinds[] = {static_cast<int>(rng.bits() & 255), 77, 3 * x + c, 5 * y,
                                     x * y / 7 + 2 * c};
                picture.bytes.push_back(static_cast<std::uint8_t>(kinds[y / 8 % 5]));
            }
    return picture;
}

TEST(PngFile, EveryByteComesBack) {
    expect_same(picture_of(67, 83, 3));
    expect_same(picture_of(1, 1, 3));
    expect_same(picture_of(1, 50, 3));
    expect_same(picture_of(50, 1, 3));
}

TEST(PngFile, AlphaComesBack) {
    BytePicture picture = picture_of(31, 47, 4);
    for (std::size_t i = 3; i < picture.bytes.size(); i += 4)
        picture.bytes[i] |= 0x80; // black where nothing is seen
    expect_same(picture);
}

TEST(PngFile, RefusesWhatIsNoPicture) {
    EXPECT_THROW(png_bytes({0, 1, 3, {}, {}}), std::invalid_argument);
    EXPECT_THROW(png_bytes({2, 1, 3, {1, 2, 3}, {}}), std::invalid_argument);
    EXPECT_THROW(png_bytes({1, 1, 2, {1, 2}, {}}), std::invalid_argument);
}

} // namespace
} // namespace pnr
