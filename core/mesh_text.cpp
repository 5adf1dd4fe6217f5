// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ [Wavefront 1992], OFF [Geomview], STL [3D Systems 1988].
#include "core/mesh_cursor.h"
#include "core/mesh_materials.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace pnr {

namespace {

// ---- OBJ

// An OBJ index counts from 1, or back from the last one said when negative.
std::uint32_t obj_index(const MeshCursor& in, std::int64_t said, std::size_t count) {
    const std::int64_t index = said > 0 ? said - 1 : said + static_cast<std::int64_t>(count);
    if (said == 0 || index < 0 || index >= static_cast<std::int64_t>(count))
        in.fail("a face names element " + std::to_string(said) + " of " + std::to_string(count));
    return static_cast<std::uint32_t>(index);
}

struct ObjCorner {
    std::uint32_t position = 0, uv = 0, normal = 0;
    bool has_uv = false, has_normal = false;
};

ObjCorner obj_corner(MeshCursor& in, const MeshData& mesh) {
    ObjCorner corner;
    std::int64_t said = 0;
    if (!in.number(said)) in.fail("expected a face's vertex");
    corner.position = obj_index(in, said, mesh.positions.size());
    for (int part = 0; part < 2 && in.at != in.end && *in.at == '/'; ++part) {
        ++in.at;
        if (!in.number(said)) continue; // `v//n`
        if (part == 0)
            corner.uv = obj_index(in, said, mesh.uvs.size()), corner.has_uv = true;
        else
            corner.normal = obj_index(in, said, mesh.normals.size()), corner.has_normal = true;
    }
    if (in.at != in.end && !MeshCursor::is_blank(*in.at) && *in.at != '\n')
        in.fail("a face's vertex is malformed");
    return corner;
}

// ---- STL

// Corners of STL triangles carry no names: those at the same place are one vertex.
struct Welder {
    struct Hash {
        std::size_t operator()(const Vec3f& p) const {
            std::uint64_t h = 0;
            for (int i = 0; i < 3; ++i) {
                const float x = p[i] == 0 ? 0.0f : p[i]; // -0 and 0 are one place
                std::uint32_t bits;
                std::memcpy(&bits, &x, 4);
                h = (h ^ bits) * 0x9e3779b97f4a7c15ull;
                h ^= h >> 29;
            }
            return static_cast<std::size_t>(h);
        }
    };
    MeshData& mesh;
    std::unordered_map<Vec3f, std::uint32_t, Hash> known{};

    std::uint32_t add(Vec3f p) {
        const auto [it, fresh] = known.try_emplace(p, static_cast<std::uint32_t>(mesh.positions.size()));
        if (fresh) mesh.positions.push_back(p);
        return it->second;
    }
};

MeshData parse_binary_stl(MeshCursor in, std::uint32_t count) {
    MeshData mesh;
    mesh.triangles.reserve(count);
    Welder welder{mesh};
    in.take(84);
    for (std::uint32_t i = 0; i < count; ++i) {
        const char* record = in.take(50); // normal, three corners, two bytes of attributes
        float v[9];
        std::memcpy(v, record + 12, sizeof v);
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f p(v[3 * k], v[3 * k + 1], v[3 * k + 2]);
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                in.fail("facet " + std::to_string(i) + " is not finite");
            triangle[k] = welder.add(p);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

} // namespace

namespace {

// What `mtllib` and `usemtl` say: files, and which material each triangle has.
struct ObjMaterials {
    std::vector<std::string> files, names;
    std::uint32_t current = no_texture;
    std::vector<std::uint32_t> of_triangle;

    void use(std::string_view name) {
        const auto found = std::find(names.begin(), names.end(), name);
        current = static_cast<std::uint32_t>(found - names.begin());
        if (found == names.end()) names.emplace_back(name);
    }
};

// The textures of the materials that are known; triangles of others show the object's.
void add_textures(MeshData& mesh, const ObjMaterials& said, const std::filesystem::path& folder, const SourceRef& said_at) {
    std::map<std::string, Texture, std::less<>> known;
    for (const std::string& file : said.files)
        if (stays_below(file)) known.merge(read_materials(folder / file, said_at));
    auto textures = std::make_shared<PartTextures>();
    std::vector<std::uint32_t> numbers;
    for (const std::string& name : said.names) {
        const auto found = known.find(name);
        numbers.push_back(found == known.end() ? no_texture : static_cast<std::uint32_t>(textures->list.size()));
        if (found != known.end()) textures->list.push_back(found->second);
    }
    if (textures->list.empty()) return;
    mesh.textures = std::move(textures);
    for (const std::uint32_t material : said.of_triangle) {
        const std::uint32_t number = material == no_texture ? no_texture : numbers[material];
        mesh.texture_triangles.push_back({number, number, number});
    }
}

} // namespace

MeshData parse_obj(MeshCursor in, const std::filesystem::path* folder) {
    MeshBuilder builder;
    MeshData& mesh = builder.mesh;
    ObjMaterials materials;
    bool all_uvs = true, all_normals = true;
    std::vector<ObjCorner> corners;
    for (; in.at != in.end; in.skip_line()) {
        const std::string_view word = in.word();
        if (word == "v") {
            mesh.positions.emplace_back(in.need_point());
        } else if (word == "vn") {
            mesh.normals.emplace_back(in.need_point());
        } else if (word == "vt") {
            const double u = in.need_number<double>("a texture coordinate");
            mesh.uvs.emplace_back(u, in.at_line_end() ? 0.0 : in.need_number<double>("a texture coordinate"));
        } else if (word == "f") {
            corners.clear();
            while (!in.at_line_end()) corners.push_back(obj_corner(in, mesh));
            for (const ObjCorner& c : corners) all_uvs &= c.has_uv, all_normals &= c.has_normal;
            for (std::size_t i = 2; i < corners.size(); ++i) {
                const ObjCorner &a = corners[0], &b = corners[i - 1], &c = corners[i];
                mesh.triangles.push_back({a.position, b.position, c.position});
                mesh.uv_triangles.push_back({a.uv, b.uv, c.uv});
                mesh.normal_triangles.push_back({a.normal, b.normal, c.normal});
                materials.of_triangle.push_back(materials.current);
            }
        } else if (word == "usemtl") {
            materials.use(in.word());
        } else if (word == "mtllib") {
            while (!in.at_line_end()) materials.files.emplace_back(in.word());
        }
    }
    if (folder && !materials.names.empty()) add_textures(mesh, materials, *folder, in.said_at);
    if (!all_uvs || mesh.uvs.empty()) mesh.uvs.clear(), mesh.uv_triangles.clear();
    if (!all_normals || mesh.normals.empty()) mesh.normals.clear(), mesh.normal_triangles.clear();
    return std::move(mesh);
}

MeshData parse_off(MeshCursor in) {
    const auto skip_comments = [&] {
        for (in.skip_space(); in.at != in.end && *in.at == '#'; in.skip_space()) in.skip_line();
    };
    const std::string_view kind = in.word();
    if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF")
        in.fail("OFF files of kind '" + std::string(kind) + "' are not read");
    skip_comments();
    const auto vertices = in.need_number<std::uint64_t>("the number of vertices");
    const auto faces = in.need_number<std::uint64_t>("the number of faces");
    in.skip_line(); // the number of edges, which nobody needs
    if (vertices > in.left() / 6 + 1 || faces > in.left() / 2 + 1)
        in.fail("the header promises more than the file holds");
    MeshBuilder builder;
    builder.mesh.positions.reserve(vertices);
    for (std::uint64_t i = 0; i < vertices; ++i) {
        skip_comments();
        builder.mesh.positions.emplace_back(in.need_point());
        in.skip_line(); // colours and normals
    }
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < faces; ++i) {
        skip_comments();
        const auto count = in.need_number<std::uint64_t>("a face's number of corners");
        if (count > in.left()) in.fail("a face is longer than the file");
        corners.resize(count);
        for (std::uint32_t& corner : corners) {
            corner = in.need_number<std::uint32_t>("a face's vertex");
            if (corner >= vertices)
                in.fail("face " + std::to_string(i) + " names a vertex that does not exist");
        }
        builder.add_polygon(corners.data(), corners.size());
        in.skip_line();
    }
    return std::move(builder.mesh);
}

MeshData parse_stl(MeshCursor in) {
    // Some binary files begin with "solid" too: the length tells.
    if (in.left() >= 84) {
        std::uint32_t count;
        std::memcpy(&count, in.at + 80, 4);
        const std::uint64_t size = 84 + 50 * static_cast<std::uint64_t>(count);
        const bool text = std::string_view(in.at, 5) == "solid";
        if (in.left() == size || (!text && in.left() > size)) return parse_binary_stl(in, count);
        if (!text)
            in.fail("the header promises " + std::to_string(count) + " facets, more than the file holds");
    }
    MeshBuilder builder;
    Welder welder{builder.mesh};
    std::vector<std::uint32_t> corners;
    for (; in.at != in.end; in.skip_line()) {
        const std::string_view word = in.word();
        if (word == "vertex") {
            const Vec3f p(in.need_point());
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                in.fail("a vertex is not finite");
            corners.push_back(welder.add(p));
        } else if (word == "endloop") {
            builder.add_polygon(corners.data(), corners.size());
            corners.clear();
        }
    }
    return std::move(builder.mesh);
}

} // namespace pnr
