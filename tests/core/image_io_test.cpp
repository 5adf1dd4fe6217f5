// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/image_io.h"

#include "core/atomic_file.h"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

namespace pnr {
namespace {

namespace fs = std::filesystem;

class ImageIo : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "pnr-image-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    void TearDown() override { fs::remove_all(folder); }
    std::size_t files_left() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
    fs::path folder;
};

ImagePart make_part(const std::string& name, std::vector<std::string> channels, int pixels, bool half) {
    ImagePart part{name, std::move(channels), {}, half};
    for (std::size_t i = 0; i < static_cast<std::size_t>(pixels) * part.channel_names.size(); ++i)
        part.data.push_back(static_cast<float>(i) * 0.25f);
    return part;
}

TEST_F(ImageIo, ExrGivesBackChannelsPartsWindowAndMetadata) {
    ImageFile image{10, 8, {2, 3, 5, 7}, {}, {{"pnr:radius.2", 7.5f}, {"scene", "pot.pnr"}}};
    image.parts = {make_part("beauty", {"R", "G", "B", "A"}, 12, true),
                   make_part("N", {"N.X", "N.Y", "N.Z"}, 12, false)};
    write_exr(folder / "a.exr", image);
    const ImageFile read = read_exr(folder / "a.exr");
    EXPECT_EQ(read.width, 10);
    EXPECT_EQ(read.height, 8);
    EXPECT_EQ(read.data_window.x0, 2);
    EXPECT_EQ(read.data_window.y0, 3);
    EXPECT_EQ(read.data_window.x1, 5);
    EXPECT_EQ(read.data_window.y1, 7);
    ASSERT_EQ(read.parts.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.parts[i].name, image.parts[i].name);
        EXPECT_EQ(read.parts[i].channel_names, image.parts[i].channel_names);
        EXPECT_EQ(read.parts[i].data, image.parts[i].data);
        EXPECT_EQ(read.parts[i].half, image.parts[i].half);
    }
    for (const auto& entry : image.metadata)
        EXPECT_NE(std::find(read.metadata.begin(), read.metadata.end(), entry), read.metadata.end()) << entry.first;
    EXPECT_EQ(files_left(), 1u);
}

TEST_F(ImageIo, FloatChannelsKeepEveryBit) {
    ImageFile image{3, 1, {}, {}, {}};
    image.parts = {{"", {"id.object"}, {16777215.0f, 1e-30f, -0.1f}, false}};
    write_exr(folder / "a.exr", image);
    EXPECT_EQ(read_exr(folder / "a.exr").parts[0].data, image.parts[0].data);
}

TEST_F(ImageIo, PngIsSrgbClippedAndNeverNotANumber) {
    Image<Color> picture(4, 1);
    picture.pixels = {Color(0.214041f), Color(7), Color(-1), Color(std::numeric_limits<float>::quiet_NaN())};
    write_png(folder / "a.png", picture, {}, {});
    const Image<glm::vec4> read = read_image(folder / "a.png");
    // 0.214041 is the linear value of sRGB 0.5, that is byte 127.5, so 127 or 128.
    EXPECT_NEAR(read.pixels[0].x, 0.214041f, 0.002f);
    EXPECT_EQ(read.pixels[1], glm::vec4(1));
    EXPECT_EQ(read.pixels[2], glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(read.pixels[3], glm::vec4(0, 0, 0, 1));
}

TEST_F(ImageIo, PngAlphaIsNotAssociated) {
    Image<Color> picture(1, 1, Color(0.25f, 0, 0));
    write_png(folder / "a.png", picture, Image<float>(1, 1, 0.5f), {});
    const glm::vec4 read = read_image(folder / "a.png").pixels[0];
    EXPECT_NEAR(read.x, 0.5f, 0.01f);
    EXPECT_NEAR(read.w, 0.5f, 0.01f);
}

TEST_F(ImageIo, ReasonsOfFailureAreNamed) {
    const auto reason = [&](auto work) -> std::string {
        try {
            work();
        } catch (const FileError& error) {
            return error.what();
        }
        return "no error";
    };
    const Image<Color> picture(2, 2);
    EXPECT_NE(reason([&] { write_png(folder / "no" / "a.png", picture, {}, {}); }).find("there is no folder"),
              std::string::npos);
    EXPECT_NE(reason([&] { write_png(folder, picture, {}, {}); }).find("directory"), std::string::npos);
    EXPECT_NE(reason([&] { write_png("/dev/full", picture, {}, {}); }).find("No space left"),
              std::string::npos);
    EXPECT_NE(reason([&] { read_image(folder / "absent.png"); }).find("no such file"), std::string::npos);
    std::ofstream(folder / "noise.png") << "this is no picture";
    EXPECT_NE(reason([&] { read_image(folder / "noise.png"); }), "no error");
}

TEST_F(ImageIo, AFailedWriteLeavesTheOldFileAndNothingElse) {
    write_file_atomically(folder / "a.txt", "old");
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit small = before;
    small.rlim_cur = 10; // as a full disk would, in the middle of the file
    std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    EXPECT_THROW(write_file_atomically(folder / "a.txt", "new text that is longer than the limit"),
                 FileError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::string text;
    std::getline(std::ifstream(folder / "a.txt"), text);
    EXPECT_EQ(text, "old");
    EXPECT_EQ(files_left(), 1u);
}

TEST(ImageIoTransfer, SrgbMeetsTheStandardsValuesAndInverts) {
    EXPECT_FLOAT_EQ(srgb_encode(0), 0);
    EXPECT_NEAR(srgb_encode(1), 1, 1e-6);
    EXPECT_NEAR(srgb_encode(0.18f), 0.46136f, 1e-4); // 18 % grey
    for (float value = 0; value <= 1; value += 0.01f)
        EXPECT_NEAR(srgb_decode(srgb_encode(value)), value, 1e-6);
}

TEST(ImageIoTransfer, ShoulderIsSmoothKeepsHueAndStaysBelowOne) {
    EXPECT_EQ(shoulder(Color(0.45f, 0.1f, 0)), Color(0.45f, 0.1f, 0));
    const float slope = (shoulder(Color(0.4501f)).x - 0.45f) / 0.0001f;
    EXPECT_NEAR(slope, 1, 0.01);
    const Color bright = shoulder(Color(4, 2, 1));
    EXPECT_LT(bright.x, 1.0f);
    EXPECT_NEAR(bright.y / bright.x, 0.5, 1e-6);
}

} // namespace
} // namespace pnr
