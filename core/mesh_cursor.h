// SPDX-License-Identifier: GPL-3.0-or-later
// A reader's place in the bytes of a mesh file, and the checks that all formats share. Every way out of the
// bytes is a SceneError; nothing is allocated on a header's word alone.
#pragma once

#include "core/shape.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace pnr {

struct MeshCursor {
    const char* at;
    const char* end;
    const std::string& name;
    const SourceRef& said_at;

    [[noreturn]] void fail(const std::string& text) const { throw SceneError(said_at, name + ": " + text); }
    std::size_t left() const { return static_cast<std::size_t>(end - at); }

    // ---- binary
    const char* take(std::size_t bytes) {
        if (bytes > left()) fail("the file ends in the middle of its data");
        const char* start = at;
        at += bytes;
        return start;
    }

    // ---- text
    static bool is_blank(char c) {
        return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == '\v' || c == '\f';
    }
    void skip_blanks() {
        while (at != end && is_blank(*at)) ++at;
    }
    void skip_space() {
        while (at != end && (is_blank(*at) || *at == '\n')) ++at;
    }
    bool at_line_end() {
        skip_blanks();
        return at == end || *at == '\n';
    }
    void skip_line() {
        const void* found = at == end ? nullptr : std::memchr(at, '\n', left());
        at = found ? static_cast<const char*>(found) + 1 : end;
    }
    // The next word of this line; empty at its end.
    std::string_view word() {
        skip_blanks();
        const char* start = at;
        while (at != end && !is_blank(*at) && *at != '\n') ++at;
        return {start, static_cast<std::size_t>(at - start)};
    }
    // A number here, without leading space; nan and inf are read as such. False if there is none.
    template <class T>
    bool number(T& value) {
        if (at != end && *at == '+') ++at;
        const auto [stop, error] = std::from_chars(at, end, value);
        if (error == std::errc::result_out_of_range) {
            if constexpr (std::is_floating_point_v<T>) value = 0; // underflow is 0; overflow is caught below
            const char* p = at;
            while (p != stop && *p != 'e' && *p != 'E') ++p;
            if (!std::is_floating_point_v<T> || p == stop || p + 1 == stop || p[1] != '-')
                fail("a number is too large");
        } else if (error != std::errc()) {
            return false;
        }
        at = stop;
        return true;
    }
    template <class T>
    T need_number(const char* what) {
        skip_space();
        T value{};
        if (!number(value))
            fail(at == end ? "the file ends in the middle of its data" : std::string("expected ") + what);
        return value;
    }
    Vec3 need_point() {
        const double x = need_number<double>("a coordinate"), y = need_number<double>("a coordinate");
        return {x, y, need_number<double>("a coordinate")};
    }
};

// What every format fills; `finish` of mesh_io.cpp checks it.
struct MeshBuilder {
    MeshData mesh;

    void add_polygon(const std::uint32_t* corners, std::size_t count) {
        for (std::size_t i = 2; i < count; ++i)
            mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
};

MeshData parse_ply(MeshCursor in);
MeshData parse_off(MeshCursor in);
MeshData parse_obj(MeshCursor in, const std::filesystem::path* folder); // of its materials; null: none are read
MeshData parse_stl(MeshCursor in);

} // namespace pnr
