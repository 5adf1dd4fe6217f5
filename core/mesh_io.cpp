// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_io.h"

#include "core/mesh_cursor.h"

#include <algorithm>
#include <fstream>

namespace pnr {

namespace {

void check_finite(const MeshCursor& in, const MeshData& mesh) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3f p = mesh.positions[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            in.fail("vertex " + std::to_string(i) + " is not a finite point");
    }
}

bool fits(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t count) {
    return std::all_of(triangles.begin(), triangles.end(),
                       [&](const auto& t) { return t[0] < count && t[1] < count && t[2] < count; });
}

std::string lower_ending(const std::string& name) {
    const auto dot = name.rfind('.');
    std::string ending = dot == std::string::npos ? "" : name.substr(dot + 1);
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

// Normals that are missing or broken somewhere would put NaN into shading: then the file's normals are left
// out.
void drop_broken_normals(MeshData& mesh) {
    const bool usable = std::all_of(mesh.normals.begin(), mesh.normals.end(), [](Vec3f n) {
        const float length2 = glm::dot(n, n);
        return std::isfinite(length2) && length2 > 0;
    });
    if (usable) return;
    mesh.normals.clear();
    mesh.normal_triangles.clear();
}

} // namespace

MeshData parse_mesh(std::string_view bytes, const std::string& name, const SourceRef& said_at,
                    const std::filesystem::path* folder) {
    const MeshCursor in{bytes.data(), bytes.data() + bytes.size(), name, said_at};
    MeshCursor start = in;
    const std::string_view word = start.word();
    const std::string ending = lower_ending(name);
    MeshData mesh;
    if (word == "ply")
        mesh = parse_ply(in);
    else if (ending == "obj")
        mesh = parse_obj(in, folder);
    else if (word.ends_with("OFF"))
        mesh = parse_off(in);
    else if (ending == "stl" || word == "solid")
        mesh = parse_stl(in);
    else
        in.fail("this is none of PLY, OBJ, OFF and STL");
    check_finite(in, mesh);
    if (mesh.triangles.empty()) in.fail("it holds no triangle");
    if (!fits(mesh.triangles, mesh.positions.size())) in.fail("a face names a vertex that does not exist");
    if (!mesh.normals.empty() && mesh.normal_triangles.empty()) mesh.normal_triangles = mesh.triangles;
    if (!mesh.uvs.empty() && mesh.uv_triangles.empty()) mesh.uv_triangles = mesh.triangles;
    if (!fits(mesh.normal_triangles, mesh.normals.size()))
        in.fail("a face names a normal that does not exist");
    if (!fits(mesh.uv_triangles, mesh.uvs.size()))
        in.fail("a face names a texture point that does not exist");
    drop_broken_normals(mesh);
    return mesh;
}

MeshData read_mesh(const std::filesystem::path& file, const SourceRef& said_at) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) throw FileError("cannot open the mesh '" + file.string() + "'");
    const auto size = stream.tellg();
    if (size < 0) throw FileError("cannot read the mesh '" + file.string() + "'");
    std::string bytes(static_cast<std::size_t>(size), '\0');
    stream.seekg(0);
    if (!stream.read(bytes.data(), size)) throw FileError("cannot read the mesh '" + file.string() + "'");
    const std::filesystem::path folder = file.parent_path();
    return parse_mesh(bytes, file.filename().string(), said_at, &folder);
}

std::vector<Vec3f> area_weighted_normals(std::span<const Vec3f> positions,
                                         std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::vector<Vec3> sums(positions.size(), Vec3(0));
    for (const auto& t : triangles) {
        const Vec3 a(positions[t[0]]), b(positions[t[1]]), c(positions[t[2]]);
        const Vec3 n = glm::cross(b - a, c - a); // its length is twice the area
        for (const std::uint32_t v : t) sums[v] += n;
    }
    std::vector<Vec3f> normals(positions.size(), Vec3f(0));
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double largest = std::max({std::abs(sums[i].x), std::abs(sums[i].y), std::abs(sums[i].z)});
        if (largest > 0)
            normals[i] = Vec3f(glm::normalize(sums[i] / largest)); // squares of tiny areas would vanish
    }
    return normals;
}

} // namespace pnr
