// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles: alone, in meshes, in lists of numbers, in files; and bicubic patches.
#include "parser/blocks.h"
#include "parser/number_list.h"

#include <cstring>
#include <unordered_map>

#include <fmt/format.h>

namespace pnr {

namespace {

using Triple = std::array<std::uint32_t, 3>;

// Gives equal positions one index, so that the triangles of a mesh share their corners.
struct Welder {
    struct Hash {
        std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
            std::size_t h = 0;
            for (const std::uint32_t b : bits) h = (h ^ b) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
            return h;
        }
    };
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, Hash> index;

    std::uint32_t add(std::vector<Vec3f>& points, Vec3 v) {
        const Vec3f f = Vec3f(v) + 0.0f; // -0 and 0 are one place
        std::array<std::uint32_t, 3> bits;
        std::memcpy(bits.data(), &f, sizeof bits);
        const auto [entry, is_new] = index.try_emplace(bits, static_cast<std::uint32_t>(points.size()));
        if (is_new) points.push_back(f);
        return entry->second;
    }
};

struct MeshBuilder {
    MeshData data;
    Welder positions, normals;
    bool smooth = false; // normals exist from the first smooth triangle on
};

Vec3 parse_item(Parser& p) {
    const Vec3 v = parse_vector(p);
    accept_comma(p);
    return v;
}

// The normals of a flat triangle in a smooth mesh.
void add_flat_normals(MeshBuilder& mesh, const Triple& t) {
    const auto& points = mesh.data.positions;
    const Vec3 a(points[t[0]]), b(points[t[1]]), c(points[t[2]]);
    const std::uint32_t index = mesh.normals.add(mesh.data.normals, glm::cross(b - a, c - a));
    mesh.data.normal_triangles.push_back({index, index, index});
}

void add_triangle(MeshBuilder& mesh, const Vec3 (&corners)[3], const Vec3 (&normals)[3], bool smooth) {
    if (smooth && !mesh.smooth) {
        mesh.smooth = true;
        for (const Triple& earlier : mesh.data.triangles) add_flat_normals(mesh, earlier);
    }
    Triple t{}, n{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = mesh.positions.add(mesh.data.positions, corners[i]);
    mesh.data.triangles.push_back(t);
    if (!mesh.smooth) return;
    if (!smooth) return add_flat_normals(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) n[i] = mesh.normals.add(mesh.data.normals, normals[i]);
    mesh.data.normal_triangles.push_back(n);
}

// Three corners, each followed by its normal if smooth.
void parse_corners(Parser& p, MeshBuilder& mesh, bool smooth) {
    const Token at = peek(p);
    Vec3 corners[3], normals[3];
    for (int i = 0; i < 3; ++i) {
        corners[i] = parse_item(p);
        if (smooth) normals[i] = parse_item(p);
    }
    charge(p, at, 2 * sizeof(Triple) + 2 * sizeof(Vec3f));
    add_triangle(mesh, corners, normals, smooth);
}

Mesh finish_mesh(Parser& p, const Token& at, MeshBuilder&& builder) {
    Mesh mesh;
    mesh.data = std::make_shared<const MeshData>(std::move(builder.data));
    mesh.said_at = source_ref(p, at);
    return mesh;
}

Shape parse_one_triangle(Parser& p, bool smooth) {
    const Token at = peek(p);
    MeshBuilder builder;
    parse_corners(p, builder, smooth);
    return finish_mesh(p, at, std::move(builder));
}

void parse_uv_corners(Parser& p, MeshBuilder& mesh) {
    MeshData& data = mesh.data;
    data.uv_triangles.resize(data.triangles.size() - 1, Triple{0, 0, 0});
    if (data.uvs.empty()) data.uvs.emplace_back(0.0f); // of triangles that say none
    Triple t{};
    for (std::uint32_t& corner : t) {
        corner = static_cast<std::uint32_t>(data.uvs.size());
        data.uvs.emplace_back(parse_uv(p));
        accept_comma(p);
    }
    data.uv_triangles.push_back(t);
}

// A triangle's braces inside `mesh`.
void parse_mesh_triangle(Parser& p, MeshBuilder& mesh, bool smooth) {
    bool started = false;
    block(p, smooth ? "smooth_triangle" : "triangle", [&] {
        const Token word = peek(p);
        if (!started)
            started = true, parse_corners(p, mesh, smooth);
        else if (accept(p, "uv_vectors"_kw))
            parse_uv_corners(p, mesh);
        else if (at(p, "texture"_kw) || at(p, "texture_list"_kw)) {
            warn_unsupported(p, next(p), "texture of single triangles", "a mesh has one texture");
            skip_block(p, token_text(p, word, false));
        } else
            unexpected(p, "triangle", {"uv_vectors"_kw, "texture"_kw});
    });
}

// `file "bunny.ply"`; `smooth on` is among the modifiers.
Mesh parse_mesh_file(Parser& p) {
    Mesh mesh;
    const Token name = peek(p);
    mesh.said_at = source_ref(p, name);
    mesh.file = resolve_file(p, name, parse_string(p));
    return mesh;
}

// ---- mesh2
// ----------------------------------------------------------------------------------------------------

std::size_t parse_count(Parser& p) {
    const Token at = peek(p);
    const int count = parse_int(p, 0, 1 << 30, "the count of a list");
    accept_comma(p);
    if (count == 0) fail(p, at, "a list of `mesh2` needs at least one entry");
    return static_cast<std::size_t>(count);
}

bool read_entry(NumberCursor& cursor, Vec3f& entry) {
    double v[3];
    if (!read_vector(cursor, 3, v)) return false;
    entry = Vec3f(v[0], v[1], v[2]);
    return true;
}
bool read_entry(NumberCursor& cursor, Vec2f& entry) {
    double v[2];
    if (!read_vector(cursor, 2, v)) return false;
    entry = Vec2f(v[0], v[1]);
    return true;
}
bool read_entry(NumberCursor& cursor, Triple& entry) {
    double v[3];
    if (!read_vector(cursor, 3, v)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(v[i] >= 0 && v[i] < 4294967295.0)) return false;
        entry[i] = static_cast<std::uint32_t>(v[i]);
    }
    return true;
}

// The whole list from its text: the count, then as many entries, and nothing else.
template <class T>
bool read_number_list(Parser& p, const Token& opener, std::vector<T>& list) {
    const auto text = peek_number_list(p);
    if (!text) return false;
    NumberCursor cursor(*text);
    double count = 0;
    // An entry takes at least 5 bytes: no memory for a count that the text cannot hold.
    if (!read_number(cursor, count) || count < 1 || count * 5 > static_cast<double>(text->size())) return false;
    charge(p, opener, static_cast<std::size_t>(count) * sizeof(T));
    list.resize(static_cast<std::size_t>(count));
    for (T& entry : list) {
        skip_comma(cursor);
        if (!read_entry(cursor, entry)) return false;
    }
    skip_comma(cursor);
    if (!at_list_end(cursor)) return false;
    take_number_list(p);
    return true;
}

template <class T, class F>
void parse_list(Parser& p, std::string_view what, std::vector<T>& list, F item) {
    const Token opener = peek(p);
    open_block(p, what);
    if (read_number_list(p, opener, list)) {
        close_block(p);
        return;
    }
    const std::size_t count = parse_count(p);
    charge(p, opener, count * sizeof(T));
    list.clear();
    list.reserve(std::min<std::size_t>(count, 1 << 16)); // the count is only said so far
    while (list.size() < count) {
        if (at(p, '}'))
            fail(p, peek(p), fmt::format("`{}` says {} entries, here are {}", what, count, list.size()));
        list.push_back(item());
        accept_comma(p);
    }
    if (!close_block(p)) fail(p, peek(p), fmt::format("`{}` says {} entries, here are more", what, count));
}

// <a, b, c>, then POV-Ray's texture indices, which we lack.
Triple parse_triple(Parser& p) {
    const Token at = peek(p);
    const Vec3 v = parse_vector(p);
    Triple t{};
    for (int i = 0; i < 3; ++i) {
        const double rounded = std::floor(v[i]);
        if (!(rounded >= 0 && rounded < 4294967295.0))
            fail(p, at, fmt::format("{} is no index into a list", v[i]));
        t[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(rounded);
    }
    return t;
}

Triple parse_face(Parser& p) {
    const Triple t = parse_triple(p);
    accept_comma(p);
    while (peek(p).kind == TokenKind::number) {
        warn_unsupported(p, peek(p), "texture_list", "a mesh has one texture");
        parse_float(p), accept_comma(p);
    }
    return t;
}

void check_indices(Parser& p, const Token& at, std::string_view what, const std::vector<Triple>& triples,
                   std::size_t size) {
    for (std::size_t i = 0; i < triples.size(); ++i)
        for (const std::uint32_t index : triples[i])
            if (index >= size)
                fail(
                    p, at,
                    fmt::format("entry {} of `{}` names number {}, but there are only {} (they count from 0)",
                                i, what, index, size));
}

bool parse_mesh2_list(Parser& p, MeshData& data) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "vertex_vectors"_kw:
        next(p), parse_list(p, "vertex_vectors", data.positions, [&] { return Vec3f(parse_vector(p)); });
        return true;
    case "normal_vectors"_kw:
        next(p), parse_list(p, "normal_vectors", data.normals, [&] { return Vec3f(parse_vector(p)); });
        return true;
    case "uv_vectors"_kw:
        next(p), parse_list(p, "uv_vectors", data.uvs, [&] { return Vec2f(parse_uv(p)); });
        return true;
    case "face_indices"_kw:
        next(p), parse_list(p, "face_indices", data.triangles, [&] { return parse_face(p); });
        return true;
    case "normal_indices"_kw:
        next(p), parse_list(p, "normal_indices", data.normal_triangles, [&] { return parse_triple(p); });
        return true;
    case "uv_indices"_kw:
        next(p), parse_list(p, "uv_indices", data.uv_triangles, [&] { return parse_triple(p); });
        return true;
    case "texture_list"_kw:
        warn_unsupported(p, next(p), "texture_list", "a mesh has one texture");
        skip_block(p, "texture_list");
        return true;
    case "inside_vector"_kw:
        next(p), parse_vector(p);
        return true;
    default:
        return false;
    }
}

// Fills the index lists that POV-Ray lets an author leave out, and checks all.
void complete_mesh2(Parser& p, const Token& at, MeshData& data) {
    if (data.positions.empty()) fail(p, at, "`mesh2` needs `vertex_vectors`");
    if (data.triangles.empty()) fail(p, at, "`mesh2` needs `face_indices`");
    check_indices(p, at, "face_indices", data.triangles, data.positions.size());
    if (data.normals.empty())
        data.normal_triangles.clear();
    else if (data.normal_triangles.empty())
        data.normal_triangles = data.triangles;
    if (data.uvs.empty())
        data.uv_triangles.clear();
    else if (data.uv_triangles.empty())
        data.uv_triangles = data.triangles;
    check_indices(p, at, "normal_indices", data.normal_triangles, data.normals.size());
    check_indices(p, at, "uv_indices", data.uv_triangles, data.uvs.size());
    for (const auto* list : {&data.normal_triangles, &data.uv_triangles})
        if (!list->empty() && list->size() != data.triangles.size())
            fail(p, at,
                 fmt::format("`{}` has {} entries, `face_indices` has {}",
                             list == &data.uv_triangles ? "uv_indices" : "normal_indices", list->size(),
                             data.triangles.size()));
}

} // namespace

Shape parse_triangle(Parser& p) { return parse_one_triangle(p, false); }
Shape parse_smooth_triangle(Parser& p) { return parse_one_triangle(p, true); }

Shape parse_mesh(Parser& p) {
    const Token start = peek(p);
    if (accept(p, "file"_kw)) return parse_mesh_file(p);
    MeshBuilder builder;
    for (;;) {
        if (accept(p, "triangle"_kw))
            parse_mesh_triangle(p, builder, false);
        else if (accept(p, "smooth_triangle"_kw))
            parse_mesh_triangle(p, builder, true);
        else if (accept(p, "inside_vector"_kw))
            parse_vector(p);
        else
            break;
    }
    if (builder.data.triangles.empty())
        unexpected(p, "mesh", {"triangle"_kw, "smooth_triangle"_kw, "file"_kw});
    if (!builder.data.uv_triangles.empty())
        builder.data.uv_triangles.resize(builder.data.triangles.size(), Triple{0, 0, 0});
    return finish_mesh(p, start, std::move(builder));
}

Shape parse_mesh2(Parser& p) {
    const Token start = peek(p);
    MeshData data;
    while (parse_mesh2_list(p, data)) accept_comma(p);
    complete_mesh2(p, start, data);
    Mesh mesh;
    mesh.data = std::make_shared<const MeshData>(std::move(data));
    mesh.said_at = source_ref(p, start);
    return mesh;
}

Shape parse_bicubic_patch(Parser& p) {
    BicubicPatch patch;
    patch.u_steps = patch.v_steps = 0; // POV-Ray's defaults
    for (;;) {
        const Token word = peek(p);
        switch (keyword_of(word)) {
        case "type"_kw:
            next(p), parse_int(p, 0, 1, "`type` of a patch");
            break;
        case "flatness"_kw:
            next(p), patch.flatness = parse_float_in(p, 0, 1e300, "`flatness`");
            break;
        case "u_steps"_kw:
            next(p), patch.u_steps = parse_int(p, 0, 8, "`u_steps`");
            break;
        case "v_steps"_kw:
            next(p), patch.v_steps = parse_int(p, 0, 8, "`v_steps`");
            break;
        case "accuracy"_kw:
            next(p), parse_float(p);
            break;
        default:
            for (Vec3& point : patch.points) point = parse_item(p);
            constexpr std::size_t triangle_bytes = 200; // with its share of the BVH
            charge(p, word, (std::size_t{2} << (patch.u_steps + patch.v_steps)) * triangle_bytes);
            return patch;
        }
        accept_comma(p);
    }
}

} // namespace pnr
