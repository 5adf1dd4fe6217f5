// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles: alone, in meshes, in lists of numbers, in files; and bicubic patches.
#include "parser/blocks.h"
#include "parser/number_list.h"

#include <cstring>
#include <map>
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

// The textures of a mesh's parts. One that is only the name of a declared texture is kept once, however often
// it stands there.
struct TextureCollector {
    PartTextures textures;
    std::map<std::shared_ptr<const DeclaredBlock>, std::uint32_t> declared;
};

struct MeshBuilder {
    MeshData data;
    Welder positions, normals;
    TextureCollector textures;
    bool smooth = false; // normals exist from the first smooth triangle on
};

// What `{ Name }` names, if just that is next.
std::shared_ptr<const DeclaredBlock> lone_declared(const Parser& p) {
    const TokenFrame& frame = p.in.frames.back();
    if (p.in.buffered || frame.position + 3 > frame.end) return nullptr;
    const StoredToken* const next = frame.tokens + frame.position;
    const auto is_brace = [](const StoredToken& token, char c) {
        return kind_of(token) == TokenKind::punctuation && token.name.symbol == static_cast<Symbol>(c);
    };
    if (!is_brace(next[0], '{') || kind_of(next[1]) != TokenKind::word || !is_brace(next[2], '}'))
        return nullptr;
    const Value* value = lookup(p.in, next[1].name.symbol);
    const auto* block = value ? std::get_if<std::shared_ptr<const DeclaredBlock>>(&value->data) : nullptr;
    return block ? *block : nullptr;
}

// Behind `texture`: its number.
std::uint32_t parse_part_texture(Parser& p, TextureCollector& all) {
    const Token at = peek_raw(p);
    const auto name = lone_declared(p);
    if (const auto known = all.declared.find(name); name && known != all.declared.end()) {
        skip_block(p, "texture");
        return known->second;
    }
    const auto number = static_cast<std::uint32_t>(all.textures.list.size());
    all.textures.list.push_back(parse_texture(p, p.default_texture));
    charge(p, at, sizeof(Texture));
    if (name) all.declared.emplace(name, number);
    return number;
}

// From here on triangles have textures; those said before have none of their own.
void set_texture(MeshData& data, const Triple& numbers) {
    data.texture_triangles.resize(data.triangles.size() - 1, Triple{no_texture, no_texture, no_texture});
    data.texture_triangles.push_back(numbers);
}

void finish_textures(MeshData& data, TextureCollector&& collected) {
    if (data.texture_triangles.empty()) return;
    data.texture_triangles.resize(data.triangles.size(), Triple{no_texture, no_texture, no_texture});
    data.textures = std::make_shared<const PartTextures>(std::move(collected.textures));
}

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
    finish_textures(builder.data, std::move(builder.textures));
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

// `texture_list { T1 T2 T3 }`: of the corners, by name or in full.
void parse_corner_textures(Parser& p, MeshBuilder& mesh) {
    Triple numbers{};
    open_block(p, "texture_list");
    for (std::uint32_t& number : numbers) {
        const Token word = peek(p);
        if (const auto* declared = accept_declared<Texture>(p)) {
            number = static_cast<std::uint32_t>(mesh.textures.textures.list.size());
            mesh.textures.textures.list.push_back(*declared);
            charge(p, word, sizeof(Texture));
        } else if (accept(p, "texture"_kw)) {
            number = parse_part_texture(p, mesh.textures);
        } else {
            unexpected(p, "texture_list", {"texture"_kw});
        }
        accept_comma(p);
    }
    if (!close_block(p))
        fail(p, peek(p), "a triangle's `texture_list` has three textures, one for each corner");
    set_texture(mesh.data, numbers);
}

// A triangle's braces inside `mesh`.
void parse_mesh_triangle(Parser& p, MeshBuilder& mesh, bool smooth) {
    bool started = false;
    block(p, smooth ? "smooth_triangle" : "triangle", [&] {
        if (!started)
            started = true, parse_corners(p, mesh, smooth);
        else if (accept(p, "uv_vectors"_kw))
            parse_uv_corners(p, mesh);
        else if (accept(p, "texture"_kw)) {
            const std::uint32_t number = parse_part_texture(p, mesh.textures);
            set_texture(mesh.data, {number, number, number});
        } else if (accept(p, "texture_list"_kw))
            parse_corner_textures(p, mesh);
        else
            unexpected(p, "triangle", {"uv_vectors"_kw, "texture"_kw, "texture_list"_kw});
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

bool fits_float(double v) { return std::abs(v) < 3e38; }

bool read_entry(NumberCursor& cursor, std::vector<Vec3f>& list) {
    double v[3];
    if (!read_vector(cursor, 3, v) || !fits_float(v[0]) || !fits_float(v[1]) || !fits_float(v[2]))
        return false;
    list.emplace_back(Vec3(v[0], v[1], v[2]));
    return true;
}
bool read_entry(NumberCursor& cursor, std::vector<Vec2f>& list) {
    double v[2];
    if (!read_vector(cursor, 2, v) || !fits_float(v[0]) || !fits_float(v[1])) return false;
    list.emplace_back(Vec2(v[0], v[1]));
    return true;
}

bool to_triple(const double (&v)[3], Triple& t) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(v[i] >= 0 && v[i] < 4294967295.0)) return false;
        t[i] = static_cast<std::uint32_t>(v[i]);
    }
    return true;
}

bool read_entry(NumberCursor& cursor, std::vector<Triple>& list) {
    double v[3];
    Triple t;
    if (!read_vector(cursor, 3, v) || !to_triple(v, t)) return false;
    list.push_back(t);
    return true;
}

// One texture number for the whole face, or three for its corners.
bool take_face_textures(const double (&v)[3], std::size_t found, MeshData& data) {
    if (found == 2) return false;
    const double all[3] = {v[0], v[found == 3 ? 1 : 0], v[found == 3 ? 2 : 0]};
    Triple t;
    if (!to_triple(all, t)) return false;
    return set_texture(data, t), true;
}

bool read_face(NumberCursor& cursor, MeshData& data) {
    if (!read_entry(cursor, data.triangles)) return false;
    double v[3];
    std::size_t found = 0;
    for (;;) {
        skip_comma(cursor);
        if (found == 3 || !read_number(cursor, v[found])) break;
        ++found;
    }
    return found == 0 || take_face_textures(v, found, data);
}

// The whole list from its text: the count, then as many entries, and nothing else.
template <class T, class R>
bool read_number_list(Parser& p, const Token& opener, std::vector<T>& list, R read) {
    const auto text = peek_number_list(p);
    if (!text) return false;
    NumberCursor cursor(*text);
    double count = 0;
    // An entry takes at least 5 bytes: no memory for a count that the text cannot hold.
    if (!read_number(cursor, count) || count < 1 || count * 5 > static_cast<double>(text->size()))
        return false;
    charge(p, opener, static_cast<std::size_t>(count) * sizeof(T));
    list.reserve(static_cast<std::size_t>(count));
    while (list.size() < static_cast<std::size_t>(count)) {
        skip_comma(cursor);
        if (!read(cursor)) return false;
    }
    skip_comma(cursor);
    if (!at_list_end(cursor)) return false;
    take_number_list(p);
    return true;
}

// `read` appends an entry from a list's text, `item` one from its tokens; `clear` starts anew.
template <class T, class C, class R, class F>
void parse_list(Parser& p, std::string_view what, std::vector<T>& list, C clear, R read, F item) {
    const Token opener = peek(p);
    open_block(p, what);
    clear();
    if (read_number_list(p, opener, list, read)) {
        close_block(p);
        return;
    }
    clear();
    const std::size_t count = parse_count(p);
    charge(p, opener, count * sizeof(T));
    list.reserve(std::min<std::size_t>(count, 1 << 16)); // the count is only said so far
    while (list.size() < count) {
        if (at(p, '}'))
            fail(p, peek(p), fmt::format("`{}` says {} entries, here are {}", what, count, list.size()));
        item();
        accept_comma(p);
    }
    if (!close_block(p)) fail(p, peek(p), fmt::format("`{}` says {} entries, here are more", what, count));
}

template <class T, class F>
void parse_plain_list(Parser& p, std::string_view what, std::vector<T>& list, F item) {
    parse_list(
        p, what, list, [&] { list.clear(); }, [&](NumberCursor& cursor) { return read_entry(cursor, list); },
        [&] { list.push_back(item()); });
}

Triple parse_triple(Parser& p) {
    const Token at = peek(p);
    const Vec3 v = parse_vector(p);
    const double numbers[3] = {v.x, v.y, v.z};
    Triple t{};
    if (!to_triple(numbers, t)) fail(p, at, "these are no indices into a list");
    return t;
}

// <a, b, c>, then the numbers of textures.
// The next face's indices may be named: `F1 + A` with a vector F1.
bool starts_vector(Parser& p) {
    const Token& token = peek(p);
    if (is(token, '<')) return true;
    const Value* value = token.kind == TokenKind::word ? lookup(p.in, token.symbol) : nullptr;
    const auto* numbers = value ? std::get_if<VectorValue>(&value->data) : nullptr;
    return numbers && numbers->size > 1;
}

void parse_face(Parser& p, MeshData& data) {
    const Token at = peek(p);
    data.triangles.push_back(parse_triple(p));
    accept_comma(p);
    double v[3];
    std::size_t found = 0;
    while (!starts_vector(p) && at_expression(p)) {
        if (found == 3) fail(p, peek(p), "a face has one texture, or three");
        v[found++] = parse_float(p);
        accept_comma(p);
    }
    if (found > 0 && !take_face_textures(v, found, data)) fail(p, at, "a face has one texture, or three");
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

// `texture_list { count, texture { ... } ... }`
void parse_texture_list(Parser& p, TextureCollector& all) {
    open_block(p, "texture_list");
    const std::size_t count = parse_count(p);
    std::vector<Texture> list;
    while (list.size() < count && !at(p, '}')) {
        const Token word = peek(p);
        if (const auto* declared = accept_declared<Texture>(p))
            list.push_back(*declared);
        else if (accept(p, "texture"_kw))
            list.push_back(parse_texture(p, p.default_texture));
        else
            unexpected(p, "texture_list", {"texture"_kw});
        charge(p, word, sizeof(Texture));
        accept_comma(p);
    }
    if (list.size() < count || !close_block(p))
        fail(p, peek(p),
             fmt::format("`texture_list` says {} entries, here are {}", count,
                         list.size() < count ? "fewer" : "more"));
    all.textures.list = std::move(list);
}

Vec3 parse_inside_vector(Parser& p) {
    const Token at = peek(p);
    const Vec3 v = parse_vector(p);
    if (v == Vec3(0)) fail(p, at, "`inside_vector` must not be zero");
    return v;
}

bool parse_mesh2_list(Parser& p, MeshData& data, TextureCollector& textures,
                      std::optional<Vec3>& inside_vector) {
    const Token word = peek(p);
    switch (keyword_of(word)) {
    case "vertex_vectors"_kw:
        next(p),
            parse_plain_list(p, "vertex_vectors", data.positions, [&] { return Vec3f(parse_vector(p)); });
        return true;
    case "normal_vectors"_kw:
        next(p), parse_plain_list(p, "normal_vectors", data.normals, [&] { return Vec3f(parse_vector(p)); });
        return true;
    case "uv_vectors"_kw:
        next(p), parse_plain_list(p, "uv_vectors", data.uvs, [&] { return Vec2f(parse_uv(p)); });
        return true;
    case "face_indices"_kw:
        next(p),
            parse_list(
                p, "face_indices", data.triangles,
                [&] { data.triangles.clear(), data.texture_triangles.clear(); },
                [&](NumberCursor& cursor) { return read_face(cursor, data); }, [&] { parse_face(p, data); });
        return true;
    case "normal_indices"_kw:
        next(p),
            parse_plain_list(p, "normal_indices", data.normal_triangles, [&] { return parse_triple(p); });
        return true;
    case "uv_indices"_kw:
        next(p), parse_plain_list(p, "uv_indices", data.uv_triangles, [&] { return parse_triple(p); });
        return true;
    case "texture_list"_kw:
        next(p), parse_texture_list(p, textures);
        return true;
    case "inside_vector"_kw:
        next(p), inside_vector = parse_inside_vector(p);
        return true;
    default:
        return false;
    }
}

void check_textures(Parser& p, const Token& at, const MeshData& data, std::size_t size) {
    for (const Triple& t : data.texture_triangles)
        for (const std::uint32_t number : t)
            if (number != no_texture && number >= size)
                fail(p, at,
                     fmt::format("a face names texture {}, but `texture_list` has {} (they count from 0)",
                                 number, size));
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
    std::optional<Vec3> inside_vector;
    for (;;) {
        if (accept(p, "triangle"_kw))
            parse_mesh_triangle(p, builder, false);
        else if (accept(p, "smooth_triangle"_kw))
            parse_mesh_triangle(p, builder, true);
        else if (accept(p, "inside_vector"_kw))
            inside_vector = parse_inside_vector(p);
        else
            break;
    }
    if (builder.data.triangles.empty())
        unexpected(p, "mesh", {"triangle"_kw, "smooth_triangle"_kw, "file"_kw});
    if (!builder.data.uv_triangles.empty())
        builder.data.uv_triangles.resize(builder.data.triangles.size(), Triple{0, 0, 0});
    Mesh mesh = finish_mesh(p, start, std::move(builder));
    mesh.inside_vector = inside_vector;
    return mesh;
}

Shape parse_mesh2(Parser& p) {
    const Token start = peek(p);
    MeshData data;
    TextureCollector textures;
    Mesh mesh;
    while (parse_mesh2_list(p, data, textures, mesh.inside_vector)) accept_comma(p);
    complete_mesh2(p, start, data);
    check_textures(p, start, data, textures.textures.list.size());
    finish_textures(data, std::move(textures));
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
        case "uv_vectors"_kw:
            next(p);
            for (Vec2& uv : patch.corner_uv) uv = parse_uv(p), accept_comma(p);
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
