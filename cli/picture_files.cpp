// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture_files.h"

#include "cli/parts.h"
#include "core/atomic_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <unistd.h>

namespace pnr {

namespace {

namespace fs = std::filesystem;

bool is_exr(const fs::path& output) { return output.extension() == ".exr" || output.extension() == ".EXR"; }
bool is_png(const fs::path& output) { return output.extension() == ".png" || output.extension() == ".PNG"; }

Image<Color> cut(const Image<Color>& image, const PixelRect& window) {
    Image<Color> small(window.x1 - window.x0, window.y1 - window.y0);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) small.at(x, y) = image.at(window.x0 + x, window.y0 + y);
    return small;
}

Image<Color> linear_picture(const Scene& scene, const Rendering& r) {
    Image<Color> picture = r.picture.color;
    if (scene.assumed_gamma == 1) return picture;
    for (Color& color : picture.pixels)
        for (int c = 0; c < 3; ++c) color[c] = linear_from_working(color[c], scene.assumed_gamma);
    return picture;
}

Metadata describe(const Scene& scene, const Rendering& r, const std::vector<PassTime>& times) {
    Metadata metadata{{"Software", fmt::format("pnr {}", version())},
                      {"pnr:version", version()},
                      {"pnr:scene", scene.file},
                      {"pnr:scene_hash", fmt::format("{:016x}", scene.hash)},
                      {"pnr:seed", std::to_string(r.settings.render.seed)},
                      {"pnr:photons.emitted", std::to_string(r.photons.emitted)},
                      {"pnr:photons.stored", std::to_string(r.photons.photons.size())}};
    for (const PassTime& time : times)
        metadata.emplace_back("pnr:time." + time.name, static_cast<float>(time.wall_s));
    const Metadata radius = radius_metadata(r);
    metadata.insert(metadata.end(), radius.begin(), radius.end());
    return metadata;
}

std::vector<unsigned char> make_png(const Scene& scene, const Rendering& r) {
    return encode_png(shown_picture(scene, r), {}, {{"Software", fmt::format("pnr {}", version())}});
}

std::vector<unsigned char> make_exr(const Scene& scene, const Rendering& r,
                                    const std::vector<std::string>& aovs,
                                    const std::vector<PassTime>& times) {
    constexpr float largest_half = 65504;
    const int width = r.settings.render.width;
    ImageFile image{width, r.settings.render.height, r.window, {}, describe(scene, r, times)};
    ImagePart beauty = layer_part({linear_picture(scene, r), r.picture.alpha});
    beauty.name = "beauty";
    beauty.half = true;
    for (float& value : beauty.data) value = std::clamp(value, -largest_half, largest_half);
    image.parts.push_back(cut(beauty, width, r.window));
    for (const std::string& name : aovs) image.parts.push_back(cut(aov_part(r, name), width, r.window));
    return encode_exr(image);
}

// To a file, whole or not at all, or for `-` to standard output.
void write_bytes(const std::vector<unsigned char>& bytes, const fs::path& output) {
    if (output != "-") return write_file_atomically(output, bytes);
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
        throw FileError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

} // namespace

Image<Color> shown_picture(const Scene& scene, const Rendering& r) {
    Image<Color> picture = cut(linear_picture(scene, r), r.window);
    const auto gain = static_cast<float>(std::exp2(r.settings.render.exposure));
    const bool soft = r.settings.render.view == View::shoulder;
    for (Color& color : picture.pixels) color = soft ? shoulder(color * gain) : color * gain;
    return picture;
}

void check_writable(const fs::path& file) {
    std::error_code ignored;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const auto refuse = [&](const std::string& why) {
        throw FileError(fmt::format("cannot write `{}`: {}", file.string(), why));
    };
    if (!fs::is_directory(folder, ignored)) refuse(fmt::format("there is no folder `{}`", folder.string()));
    if (fs::is_directory(file, ignored)) refuse("it is a folder");
    const fs::path& touched = fs::exists(file, ignored) ? file : folder;
    if (::access(touched.c_str(), W_OK) != 0) refuse(std::strerror(errno));
}

void check_output(const fs::path& output) {
    if (output == "-") return;
    if (!is_png(output) && !is_exr(output))
        throw UsageError(fmt::format("-o {}: a picture's name ends in .png or .exr", output.string()));
    check_writable(output);
}

void write_picture(const Scene& scene, const Rendering& r, const std::vector<std::string>& aovs,
                   const std::vector<PassTime>& times, const fs::path& output) {
    if (r.picture.color.empty()) return;
    const std::vector<unsigned char> bytes =
        is_exr(output) ? make_exr(scene, r, aovs, times) : make_png(scene, r);
    write_bytes(bytes, output);
}

void write_flat_picture(const Image<Color>& picture, const fs::path& output) {
    const Metadata metadata{{"Software", fmt::format("pnr {}", version())}};
    if (!is_exr(output)) return write_bytes(encode_png(picture, {}, metadata), output);
    ImagePart part{"", {"R", "G", "B"}, {}, true};
    for (const Color& c : picture.pixels) part.data.insert(part.data.end(), {c.x, c.y, c.z});
    write_bytes(encode_exr({picture.width, picture.height, {0, 0, picture.width, picture.height}, {part}, metadata}),
                output);
}

} // namespace pnr
