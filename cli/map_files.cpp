// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_files.h"

#include "cli/parts.h"
#include "core/atomic_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace pnr {

namespace {

static_assert(std::endian::native == std::endian::little,
              "PLY is written as little-endian straight from memory");

template <class T>
void append(std::vector<unsigned char>& bytes, T value) {
    unsigned char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.insert(bytes.end(), raw, raw + sizeof(T));
}
void append(std::vector<unsigned char>& bytes, Vec3f v) {
    for (int i = 0; i < 3; ++i) append(bytes, v[i]);
}

void write_photons(const Rendering& r, const std::filesystem::path& file) {
    const PhotonMap& map = r.photons;
    const std::string header =
        fmt::format("ply\nformat binary_little_endian 1.0\ncomment emitted {}\nelement vertex {}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property float nx\nproperty float ny\nproperty float nz\n"
                    "property float dx\nproperty float dy\nproperty float dz\n"
                    "property float r\nproperty float g\nproperty float b\n"
                    "property int object\nproperty uchar npr\nproperty uchar path\n"
                    "property float tx\nproperty float ty\nproperty float tz\nend_header\n",
                    map.emitted, map.photons.size());
    std::vector<unsigned char> bytes(header.begin(), header.end());
    bytes.reserve(header.size() + map.photons.size() * 66);
    for (std::size_t i = 0; i < map.photons.size(); ++i) {
        const Photon& photon = map.photons[i];
        append(bytes, Vec3f(Vec3(photon.position) + r.world.offset));
        append(bytes, map.normals.empty() ? Vec3f(0) : map.normals[i]);
        append(bytes, photon.direction);
        append(bytes, photon.flux);
        append(bytes, static_cast<std::int32_t>(photon.object()));
        append(bytes, static_cast<std::uint8_t>(photon.npr()));
        append(bytes, static_cast<std::uint8_t>(photon.path()));
        append(bytes, r.paint.oriented.empty() ? Vec3f(0) : r.paint.oriented[i]);
    }
    write_file_atomically(file, bytes);
}

void write_map(const Rendering& r, const std::filesystem::path& file, ImagePart part, Metadata metadata) {
    ImageFile image{r.settings.render.width, r.settings.render.height, {}, {}, std::move(metadata)};
    image.parts.push_back(std::move(part));
    write_exr(file, image);
}

// How much of a pixel's square a stroke of one pixel's width covers, by the distance of its centre line.
float ink_at(Vec2f pixel, Vec2f middle, Vec2f direction, float half_length) {
    const Vec2f offset = pixel - middle;
    const float along = std::max(0.0f, std::abs(glm::dot(offset, direction)) - half_length);
    const float across = std::abs(offset.x * direction.y - offset.y * direction.x);
    return std::clamp(1.1f - std::hypot(along, across), 0.0f, 1.0f);
}

} // namespace

Image<Color> draw_orientation(const Rendering& r) {
    const InformativeMap& map = r.paint.informative;
    Image<Color> picture(r.settings.render.width, r.settings.render.height, Color(1));
    if (map.empty()) return picture;
    const int spacing = std::max(3, static_cast<int>(std::lround(scaled(11, picture.height))));
    const float half_length = 0.8f * static_cast<float>(spacing);
    const Color paper(0.82f, 0.80f, 0.75f), ink(0.01f, 0.02f, 0.06f);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        if (map.pixels[i].kind != PixelKind::outside) picture.pixels[i] = paper;
    for (int y = spacing / 2; y < picture.height; y += spacing) {
        for (int x = spacing / 2; x < picture.width; x += spacing) {
            if (map.at(x, y).kind == PixelKind::outside) continue;
            const Vec2f direction = axis_direction(map.at(x, y).axis);
            for (int v = y - spacing; v <= y + spacing; ++v) {
                for (int u = x - spacing; u <= x + spacing; ++u) {
                    if (!picture.contains(u, v)) continue;
                    const float amount = ink_at(Vec2f(u, v), Vec2f(x, y), direction, half_length);
                    picture.at(u, v) = glm::mix(picture.at(u, v), ink, amount);
                }
            }
        }
    }
    return picture;
}

void write_maps(const Rendering& r, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw FileError(fmt::format("cannot make the folder `{}`: {}", folder.string(), error.message()));
    write_photons(r, folder / "photons.ply");
    if (r.gbuffer.seen.empty()) return;
    write_map(r, folder / "gbuffer.exr", gbuffer_part(r), {});
    write_map(r, folder / "sparse.exr", sparse_part(r), {});
    write_map(r, folder / "informative.exr", informative_part(r), radius_metadata(r));
    write_png(folder / "orientation.png", draw_orientation(r), {}, {});
    if (r.picture.color.empty()) return;
    write_map(r, folder / "partial.exr", layer_part(r.paint.layer), {});
    write_map(r, folder / "photoreal.exr", layer_part(r.rendered.layer), {});
}

} // namespace pnr
