// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_materials.h"

#include "core/mesh_cursor.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// What an MTL says of a material, before it becomes a texture.
struct Said {
    Color diffuse{0.8f}, specular{0}, emission{0};
    double exponent = 0, opacity = 1;
    std::string picture;
};

float share(double v) { return static_cast<float>(std::clamp(std::isfinite(v) ? v : 0.0, 0.0, 1.0)); }

// One number is all three. `spectral` and `xyz` are not read.
bool read_color(MeshCursor& in, Color& color) {
    Color said{0};
    for (int k = 0; k < 3; ++k) {
        in.skip_blanks();
        double v = 0;
        if (!in.number(v)) {
            if (k != 1) return false;
            said = Color(said[0]);
            break;
        }
        said[k] = std::isfinite(v) ? static_cast<float>(std::max(v, 0.0)) : 0.0f;
    }
    color = said;
    return true;
}

// The rest of the line behind `map_Kd`, options (-s 1 1 1, -clamp on) passed over.
std::string read_picture_name(MeshCursor& in) {
    std::string_view name;
    while (!in.at_line_end()) name = in.word();
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return path;
}

Texture texture_of(const Said& said, const fs::path& folder, const SourceRef& said_at) {
    Texture texture;
    TextureLayer& layer = texture;
    layer.pigment.map = {{0, {glm::min(said.diffuse, Color(1)), 0, 1 - share(said.opacity)}}};
    if (!said.picture.empty() && stays_below(said.picture)) {
        ImagePattern picture;
        picture.file = (folder / said.picture).string();
        picture.said_at = said_at;
        set_kind(layer.pigment.pattern, picture);
        layer.pigment.pattern.uv_mapping = true;
    }
    layer.finish.ambient = Color(0);
    layer.finish.diffuse = 1;
    layer.finish.emission = said.emission;
    if (max_component(said.specular) > 0 && said.exponent > 0) {
        layer.finish.phong = share(max_component(said.specular));
        layer.finish.phong_size = std::min(said.exponent, 1000.0);
    }
    return texture;
}

} // namespace

bool stays_below(const fs::path& named) {
    return named.is_relative() && std::none_of(named.begin(), named.end(), [](const fs::path& p) { return p == ".."; });
}

std::map<std::string, Texture, std::less<>> parse_materials(std::string_view bytes, const fs::path& folder,
                                                            const std::string& name, const SourceRef& said_at) {
    MeshCursor in{bytes.data(), bytes.data() + bytes.size(), name, said_at};
    std::map<std::string, Said, std::less<>> all;
    Said* material = nullptr;
    for (; in.at != in.end; in.skip_line()) {
        const std::string_view word = in.word();
        if (word == "newmtl") {
            material = &all[std::string(in.word())];
            *material = {};
        } else if (!material) {
            continue;
        } else if (word == "Kd") {
            read_color(in, material->diffuse);
        } else if (word == "Ks") {
            read_color(in, material->specular);
        } else if (word == "Ke") {
            read_color(in, material->emission);
        } else if (word == "Ns" || word == "d" || word == "Tr") {
            in.skip_blanks();
            double v = 0;
            if (!in.number(v) || !std::isfinite(v)) continue;
            (word == "Ns" ? material->exponent : material->opacity) = word == "Tr" ? 1 - v : v;
        } else if (word == "map_Kd") {
            material->picture = read_picture_name(in);
        }
    }
    std::map<std::string, Texture, std::less<>> textures;
    for (const auto& [title, said] : all) textures.emplace(title, texture_of(said, folder, said_at));
    return textures;
}

std::map<std::string, Texture, std::less<>> read_materials(const fs::path& file, const SourceRef& said_at) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    return parse_materials(bytes, file.parent_path(), file.filename().string(), said_at);
}

} // namespace pnr
