// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image_io.h"

#include "core/atomic_file.h"
#include "core/image_module.h"
#include "core/module.h"
#include "core/parallel.h"
#include "core/png_file.h"

#include <cmath>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// Opened at the first picture and kept: the image library must not be unloaded under its own threads. After a
// failure the next picture tries again.
const ImageModule& image_module() {
    static const auto& module = *static_cast<const ImageModule*>(open_module(
        {"image", "OpenImageIO", "libpnr_image.so", "PNR_IMAGE_MODULE", image_module_symbol, image_module_version}));
    return module;
}

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(std::lround(255.0f * value)); }
float clip(float value) { return value > 0 ? (value < 1 ? value : 1.0f) : 0.0f; } // not a number: 0

void check_sizes(const ImageFile& image) {
    const PixelRect& w = image.data_window;
    const bool whole = w.x1 == 0;
    const auto width = static_cast<std::size_t>(whole ? image.width : w.x1 - w.x0);
    const auto height = static_cast<std::size_t>(whole ? image.height : w.y1 - w.y0);
    if (image.parts.empty()) throw std::invalid_argument("write_exr: no part");
    for (const ImagePart& part : image.parts)
        if (part.channel_names.empty() || part.data.size() != width * height * part.channel_names.size())
            throw std::invalid_argument("write_exr: part `" + part.name + "` does not fill its window");
}

DecodedPicture decode(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    const auto refuse = [&](const std::string& why) {
        throw FileError("cannot read the picture `" + file.string() + "`: " + why);
    };
    if (!fs::exists(status)) refuse("no such file");
    if (fs::is_directory(status)) refuse("it is a folder");
    DecodedPicture picture;
    const std::string why = image_module().decode(file.string(), picture);
    if (!why.empty()) refuse(why);
    if (picture.image.parts.empty()) refuse("it is empty");
    return picture;
}

int channel(const ImagePart& part, const char* name, int otherwise) {
    for (std::size_t i = 0; i < part.channel_names.size(); ++i)
        if (part.channel_names[i] == name) return static_cast<int>(i);
    return otherwise;
}

} // namespace

std::vector<unsigned char> encode_exr(const ImageFile& image) {
    check_sizes(image);
    std::vector<unsigned char> bytes;
    const std::string why = image_module().encode_exr(image, bytes);
    if (!why.empty()) throw FileError("cannot make an EXR picture: " + why);
    return bytes;
}

std::vector<unsigned char> encode_png(const Image<Color>& linear, const Image<float>& alpha,
                                      const Metadata& metadata) {
    BytePicture picture{linear.width, linear.height, alpha.empty() ? 3 : 4, {}, metadata};
    const auto channels = static_cast<std::size_t>(picture.channels);
    picture.bytes.resize(linear.pixels.size() * channels);
    constexpr std::int64_t grain = 4096;
    parallel_for(static_cast<std::int64_t>(linear.pixels.size()), grain, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            std::uint8_t* const to = picture.bytes.data() + i * channels;
            const float a = alpha.empty() ? 1.0f : clip(alpha.pixels[i]);
            const Color c = a > 0 ? linear.pixels[i] / a : Color(0);
            for (int k = 0; k < 3; ++k) to[k] = to_byte(srgb_encode(clip(c[k])));
            if (!alpha.empty()) to[3] = to_byte(a);
        }
    });
    return png_bytes(picture);
}

void write_exr(const fs::path& file, const ImageFile& image) {
    write_file_atomically(file, encode_exr(image));
}

void write_png(const fs::path& file, const Image<Color>& linear, const Image<float>& alpha,
               const Metadata& metadata) {
    write_file_atomically(file, encode_png(linear, alpha, metadata));
}

Image<glm::vec4> read_image(const fs::path& file) {
    const DecodedPicture decoded = decode(file);
    const ImagePart& part = decoded.image.parts.front();
    const PixelRect& window = decoded.image.data_window;
    Image<glm::vec4> image(window.x1 - window.x0, window.y1 - window.y0);
    const int count = static_cast<int>(part.channel_names.size());
    const int r = channel(part, "R", 0);
    const int g = channel(part, "G", count >= 3 ? 1 : r);
    const int b = channel(part, "B", count >= 3 ? 2 : r);
    const int a = channel(part, "A", -1);
    const auto linear = [&](float value) { return decoded.is_integer ? srgb_decode(value) : value; };
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float* pixel = part.data.data() + i * static_cast<std::size_t>(count);
        image.pixels[i] = {linear(pixel[r]), linear(pixel[g]), linear(pixel[b]), a < 0 ? 1.0f : pixel[a]};
    }
    return image;
}

Image<float> read_heights(const fs::path& file, bool pot) {
    Image<std::uint8_t> numbers;
    if (image_module().decode_numbers(file.string(), numbers).empty()) {
        const int width = pot ? numbers.width / 2 : numbers.width;
        Image<float> heights(width, numbers.height);
        for (int y = 0; y < heights.height; ++y)
            for (int x = 0; x < width; ++x) {
                const int low = pot ? numbers.at(x + width, y) : 0;
                heights.at(x, y) = static_cast<float>(numbers.at(x, y) * 256 + low) / 65536;
            }
        return heights;
    }
    const DecodedPicture decoded = decode(file);
    const ImagePart& part = decoded.image.parts.front();
    const PixelRect& window = decoded.image.data_window;
    Image<float> heights(window.x1 - window.x0, window.y1 - window.y0);
    const std::size_t count = part.channel_names.size();
    for (std::size_t i = 0; i < heights.pixels.size(); ++i) {
        const float* v = part.data.data() + i * count;
        if (count < 3)
            heights.pixels[i] = v[0] * 65535 / 65536;
        else if (decoded.is_integer && decoded.bits == 8)
            heights.pixels[i] = (std::round(v[0] * 255) * 256 + std::round(v[1] * 255)) / 65536;
        else
            heights.pixels[i] = (0.297f * v[0] + 0.589f * v[1] + 0.114f * v[2]) * 65535 / 65536;
    }
    return heights;
}

ImageFile read_exr(const fs::path& file) { return decode(file).image; }

float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}
float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float working_from_linear(float linear, double assumed_gamma) {
    if (assumed_gamma == 1 || !(linear > 0)) return linear;
    return assumed_gamma == 0 ? srgb_encode(linear) : static_cast<float>(std::pow(linear, 1 / assumed_gamma));
}
float linear_from_working(float working, double assumed_gamma) {
    if (assumed_gamma == 1 || !(working > 0)) return working;
    return assumed_gamma == 0 ? srgb_decode(working) : static_cast<float>(std::pow(working, assumed_gamma));
}

Color shoulder(Color linear) {
    constexpr float start = 0.45f;
    const float m = max_component(linear);
    if (!(m > start)) return linear;
    return linear * ((1 - (1 - start) * std::exp(-(m - start) / (1 - start))) / m);
}

} // namespace pnr
