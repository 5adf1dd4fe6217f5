// SPDX-License-Identifier: GPL-3.0-or-later
#include "parser/load_scene.h"

#include "parser/blocks.h"
#include "parser/expander.h"
#include "parser/library.h"
#include "parser/parser.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <new>
#include <optional>

namespace pnr {

namespace {

// After FNV-1a, over every text of the run and every declaration from outside.
std::uint64_t hash_of(const Sources& sources, const LoadOptions& options) {
    std::uint64_t h = 14695981039346656037ull;
    const auto add = [&](std::string_view text) {
        while (text.size() >= sizeof(std::uint64_t)) { // words first: the large part
            std::uint64_t word = 0;
            std::memcpy(&word, text.data(), sizeof word);
            h = (h ^ word) * 1099511628211ull;
            h ^= h >> 32;
            text.remove_prefix(sizeof word);
        }
        for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
        h = (h ^ text.size()) * 1099511628211ull;
    };
    for (const SourceText& source : sources.files) add(source.text);
    for (const auto& [name, value] : options.declares) {
        add(name);
        add(value);
    }
    add(fmt::format("{} {} {} {}", options.clock, options.frame_number, options.initial_frame,
                    options.final_frame));
    return h;
}

void declare_number(Parser& p, std::string_view name, double value) {
    assign(p, p.in.words.intern(name), Value{value}, false);
}

// The variables that POV-Ray declares before the first line. Of a single picture the frames and clocks are 0.
void declare_givens(Parser& p) {
    const LoadOptions& options = p.in.options;
    const int steps = options.final_frame - options.initial_frame;
    declare_number(p, "frame_number", options.frame_number);
    declare_number(p, "initial_frame", options.initial_frame);
    declare_number(p, "final_frame", options.final_frame);
    declare_number(p, "initial_clock", options.initial_clock);
    declare_number(p, "final_clock", options.final_clock);
    const double length = options.final_clock - options.initial_clock;
    declare_number(p, "clock_delta", steps > 0 ? length / steps : length);
    declare_number(p, "image_width", options.width.value_or(512));
    declare_number(p, "image_height", options.height.value_or(512));
    assign(p, p.in.words.intern("input_file_name"), Value{p.scene.file}, false);
}

// -D NAME=EXPR, each read as `#declare NAME = EXPR;` in a text of its own.
void declare_from_outside(Parser& p) {
    for (const auto& [name, value] : p.in.options.declares) {
        const std::uint32_t source =
            p.in.sources.add(fmt::format("-D {}", name), fmt::format("#declare {} = {};", name, value));
        push_text(p, source, Token{});
        fill_buffer(p);
        if (p.in.buffered) fail(p, p.in.buffer, "expected one expression");
        p.in.frames.clear();
    }
}

// At the token that the innermost frame came to.
void say_memory_ran_out(Expander& in) {
    Span at;
    if (!in.frames.empty()) {
        const TokenFrame& frame = in.frames.back();
        at = unpack(frame.tokens[frame.position > 0 ? frame.position - 1 : 0], frame.source, 0).span;
    }
    ++in.errors;
    in.diagnostics.push_back({Severity::error,
                              at,
                              "memory ran out while the scene was read",
                              {},
                              "does a loop make objects or arrays without an end?"});
}

} // namespace

LoadResult load_scene_text(std::string text, const std::string& name, const LoadOptions& options) {
    LoadResult result;
    Scene scene;
    scene.file = name;
    scene.povray = name.ends_with(".pov") || name.ends_with(".POV");
    Expander in(result.sources, result.diagnostics, options);
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    in.scene_folder = folder.empty() ? std::string(".") : folder.string();
    Parser p{in, scene, result.settings, {}, {}, {}};
    const std::uint32_t source = in.sources.add(name, std::move(text));
    in.main_source = source;
    try {
        in.symbols.resize(in.words.texts.size());
        declare_givens(p);
        declare_from_outside(p);
        charge(p, Token{}, in.sources.files[source].text.size());
        push_text(p, source, Token{});
        parse_scene(p);
        write_files(in);
    } catch (const ParseFailure&) {
    } catch (const ParseStop&) {
    } catch (const std::bad_alloc&) {
        scene = {}; // make room for the message
        say_memory_ran_out(in);
    }
    const double versions[] = {scene.version, scene.povray ? 1.0 : 0.0, scene.assumed_gamma,
                               static_cast<double>(scene.noise_generator)};
    for (std::uint64_t& told : in.told)
        for (const double said : versions) add_told(told, std::bit_cast<std::uint64_t>(said));
    result.world_hash = in.told[0];
    result.camera_hash = in.told[1];
    result.paint_hash = in.told[2];
    result.assets = std::move(in.assets);
    result.debug_output = std::move(in.debug_output);
    if (in.errors > 0) return result;
    scene.hash = hash_of(result.sources, options);
    result.scene = std::move(scene);
    return result;
}

LoadResult load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    const auto most = static_cast<std::size_t>(options.budgets.file_bytes);
    std::optional<std::string> text = read_text(file.string(), most);
    if (!text) throw FileError(fmt::format("{} cannot be read", file.string()));
    if (text->size() > most)
        throw FileError(fmt::format("{} is larger than {} MB; {}", file.string(), most / 1'000'000,
                                    limit_help(options.budgets, &Budgets::file_bytes)));
    return load_scene_text(std::move(*text), file.string(), options);
}

std::string default_scene_text() {
    for (const EmbeddedFile& file : embedded_files())
        if (file.name == "default.pnr") return std::string(file.text);
    return {};
}

} // namespace pnr
