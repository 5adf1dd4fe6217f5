// SPDX-License-Identifier: GPL-3.0-or-later
// PLY [Turk 1994, "The PLY polygon file format"].
#include "core/mesh_cursor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

namespace pnr {

namespace {

enum class Encoding { ascii, little, big };
enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> list; // type of the count, for a list
};
struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

std::size_t type_size(Type type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

Type parse_type(const MeshCursor& in, std::string_view word) {
    constexpr std::array<std::pair<std::string_view, Type>, 16> names{{
        {"char", Type::i8},
        {"uchar", Type::u8},
        {"short", Type::i16},
        {"ushort", Type::u16},
        {"int", Type::i32},
        {"uint", Type::u32},
        {"float", Type::f32},
        {"double", Type::f64},
        {"int8", Type::i8},
        {"uint8", Type::u8},
        {"int16", Type::i16},
        {"uint16", Type::u16},
        {"int32", Type::i32},
        {"uint32", Type::u32},
        {"float32", Type::f32},
        {"float64", Type::f64},
    }};
    for (const auto& [name, type] : names)
        if (name == word) return type;
    in.fail("unknown PLY type '" + std::string(word) + "'");
}

template <class T>
T load(const char* bytes, bool swap) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}

double load_number(const char* bytes, Type type, bool swap) {
    switch (type) {
    case Type::i8:
        return load<std::int8_t>(bytes, swap);
    case Type::u8:
        return load<std::uint8_t>(bytes, swap);
    case Type::i16:
        return load<std::int16_t>(bytes, swap);
    case Type::u16:
        return load<std::uint16_t>(bytes, swap);
    case Type::i32:
        return load<std::int32_t>(bytes, swap);
    case Type::u32:
        return load<std::uint32_t>(bytes, swap);
    case Type::f32:
        return load<float>(bytes, swap);
    case Type::f64:
        return load<double>(bytes, swap);
    }
    return 0;
}

struct Reader {
    MeshCursor in;
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;

    bool swapped() const {
        return encoding != (std::endian::native == std::endian::little ? Encoding::little : Encoding::big);
    }
    double number(Type type) {
        if (encoding == Encoding::ascii) return in.need_number<double>("a number");
        return load_number(in.take(type_size(type)), type, swapped());
    }
    std::size_t list_length(const Property& p) {
        const double length = number(*p.list);
        const std::size_t least = encoding == Encoding::ascii ? 1 : type_size(p.type);
        if (!(length >= 0) || length > static_cast<double>(in.left() / least + 1))
            in.fail("a list is longer than the file");
        return static_cast<std::size_t>(length);
    }
    void skip(const Property& p) {
        const std::size_t n = p.list ? list_length(p) : 1;
        for (std::size_t i = 0; i < n; ++i) number(p.type);
    }

    void header();
    void check_count(const Element& element) const;
    void vertices(const Element& element, MeshData& mesh);
    void faces(const Element& element, MeshBuilder& builder);
};

void Reader::header() {
    in.skip_line(); // "ply"
    bool has_format = false;
    for (;;) {
        if (in.at == in.end) in.fail("the PLY header does not end");
        const std::string_view word = in.word();
        if (word == "format") {
            const std::string_view format = in.word();
            if (format == "ascii")
                encoding = Encoding::ascii;
            else if (format == "binary_little_endian")
                encoding = Encoding::little;
            else if (format == "binary_big_endian")
                encoding = Encoding::big;
            else
                in.fail("unknown PLY format '" + std::string(format) + "'");
            has_format = true;
        } else if (word == "element") {
            Element element;
            element.name = in.word();
            in.skip_blanks();
            if (!in.number(element.count)) in.fail("a PLY element without a count");
            elements.push_back(std::move(element));
        } else if (word == "property") {
            if (elements.empty()) in.fail("a PLY property before any element");
            Property property;
            std::string_view type = in.word();
            if (type == "list") {
                property.list = parse_type(in, in.word());
                type = in.word();
            }
            property.type = parse_type(in, type);
            property.name = in.word();
            elements.back().properties.push_back(std::move(property));
        } else if (word == "end_header") {
            in.skip_line();
            if (!has_format) in.fail("the PLY header names no format");
            return;
        }
        in.skip_line();
    }
}

// Each item takes some bytes at least: a header's word is believed only as far as the file can keep it.
void Reader::check_count(const Element& element) const {
    std::size_t least = 0;
    for (const Property& p : element.properties)
        least += encoding == Encoding::ascii ? 2 : type_size(p.list ? *p.list : p.type);
    if (element.count > 0 && (least == 0 || element.count > (in.left() + 1) / least))
        in.fail("the header promises " + std::to_string(element.count) + " of '" + element.name +
                "', more than the file holds");
}

void Reader::vertices(const Element& element, MeshData& mesh) {
    std::array<int, 8> slots{-1, -1, -1, -1, -1, -1, -1, -1}; // x y z nx ny nz u v -> property
    constexpr std::array<std::string_view, 8> names{"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    const auto slot_of = [&](std::string_view name) {
        if (name == "s" || name == "texture_u") name = "u";
        if (name == "t" || name == "texture_v") name = "v";
        return std::find(names.begin(), names.end(), name) - names.begin();
    };
    std::vector<int> slot_of_property;
    for (const Property& p : element.properties) {
        const auto slot = p.list ? 8 : slot_of(p.name);
        slot_of_property.push_back(static_cast<int>(slot));
        if (slot < 8) slots[static_cast<std::size_t>(slot)] = 0;
    }
    if (slots[0] < 0 || slots[1] < 0 || slots[2] < 0) in.fail("its vertices have no x, y and z");
    const bool normals = slots[3] == 0 && slots[4] == 0 && slots[5] == 0,
               uvs = slots[6] == 0 && slots[7] == 0;
    mesh.positions.reserve(element.count);
    std::array<double, 9> v{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const Property& p = element.properties[k];
            if (p.list)
                skip(p);
            else
                v[static_cast<std::size_t>(slot_of_property[k])] = number(p.type);
        }
        mesh.positions.emplace_back(v[0], v[1], v[2]);
        if (normals) mesh.normals.emplace_back(v[3], v[4], v[5]);
        if (uvs) mesh.uvs.emplace_back(v[6], v[7]);
    }
}

void Reader::faces(const Element& element, MeshBuilder& builder) {
    builder.mesh.triangles.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& p : element.properties) {
            if (!p.list || (p.name != "vertex_indices" && p.name != "vertex_index")) {
                skip(p);
                continue;
            }
            corners.resize(list_length(p));
            for (std::uint32_t& corner : corners) {
                const double index = number(p.type);
                if (!(index >= 0 && index < static_cast<double>(builder.mesh.positions.size())))
                    in.fail("face " + std::to_string(i) + " names a vertex that does not exist");
                corner = static_cast<std::uint32_t>(index);
            }
            builder.add_polygon(corners.data(), corners.size());
        }
    }
}

} // namespace

MeshData parse_ply(MeshCursor in) {
    Reader reader{in, Encoding::ascii, {}};
    reader.header();
    MeshBuilder builder;
    for (const Element& element : reader.elements) {
        reader.check_count(element);
        if (element.name == "vertex") {
            reader.vertices(element, builder.mesh);
        } else if (element.name == "face") {
            reader.faces(element, builder);
        } else {
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const Property& p : element.properties) reader.skip(p);
        }
    }
    return std::move(builder.mesh);
}

} // namespace pnr
