// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/povray_options.h"

#include "cli/ini_file.h"
#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace pnr {

namespace {

// POV-Ray's switches that say the same as one of ours, the longest first where one starts another
// [POV-Ray 3.7 reference, "Command-line and INI-file options"].
struct Switch {
    const char* letters; // after +, upper case; the value follows at once
    const char* ours;
};
constexpr Switch switches[] = {{"WT", "--threads"}, {"W", "-W"}, {"H", "-H"},     {"O", "-o"},
                               {"L", "-L"},         {"I", ""},   {"K", "--clock"}};
// Those that mean nothing here, with or without a value: display, pauses, messages, buffers, alpha, file
// types.
constexpr const char* meaningless[] = {"UA", "UD", "UL", "UO", "UR", "UV", "AM", "BP", "BS", "GA", "GD",
                                       "GF", "GI", "GP", "GR", "GS", "GW", "HI", "MB", "MV", "RP", "SP",
                                       "EP", "XM", "B",  "C",  "D",  "F",  "P",  "V",  "X"};

// An animation's frames and clock, said apart (+KFI, +KFF, +SF, +EF, +KI, +KF, +KC).
struct Frames {
    std::string first = "1", last, subset_first, subset_last, clock_first, clock_last;
    bool cyclic = false;
};

// Name=Value, in lower case, as in .ini files.
constexpr std::pair<const char*, const char*> settings[] = {
    {"width", "-W"},         {"height", "-H"},      {"output_file_name", "-o"}, {"library_path", "-L"},
    {"work_threads", "--threads"}, {"declare", "-D"}, {"input_file_name", ""},    {"clock", "--clock"},
};
constexpr std::pair<const char*, std::string Frames::*> frame_settings[] = {
    {"initial_frame", &Frames::first},          {"final_frame", &Frames::last},
    {"subset_start_frame", &Frames::subset_first}, {"subset_end_frame", &Frames::subset_last},
    {"initial_clock", &Frames::clock_first},    {"final_clock", &Frames::clock_last},
};
// Those that mean nothing here: display, messages, POV-Ray's own ways to be fast, shell commands (never run).
constexpr const char* ignored_settings[] = {
    "display", "pause_when_done", "verbose", "output_alpha", "jitter", "jitter_amount", "antialias_depth",
    "sampling_method", "antialias_gamma", "output_to_file", "output_file_type", "compression", "bits_per_color",
    "display_gamma", "file_gamma", "video_mode", "palette", "draw_vistas", "light_buffer", "vista_buffer",
    "bounding", "bounding_method", "bounding_threshold", "bsp_maxdepth", "remove_bounds", "split_unions",
    "continue_trace", "test_abort", "test_abort_count", "preview_start_size", "preview_end_size",
    "all_console", "all_file", "debug_console", "debug_file", "fatal_console", "fatal_file", "render_console",
    "render_file", "statistic_console", "statistic_file", "warning_console", "warning_file", "warning_level",
    "create_ini", "create_histogram", "histogram_type", "histogram_grid_size", "histogram_name", "buffer_output",
    "buffer_size", "field_render", "odd_field", "radiosity_file_name", "radiosity_from_file", "radiosity_to_file",
    "radiosity_vain_pretrace", "high_reproducibility", "render_block_size", "render_block_step", "render_pattern",
    "max_image_buffer_memory", "include_header", "user_abort_command", "pre_scene_command", "pre_frame_command",
    "post_scene_command", "post_frame_command", "fatal_error_command", "user_abort_return", "pre_scene_return",
    "pre_frame_return", "post_scene_return", "post_frame_return", "fatal_error_return", "dither", "dither_method",
    "grayscale_output", "version",
};

bool starts_with_letters(const std::string& argument, const std::string& letters) {
    if (argument.size() < letters.size() + 1) return false;
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (std::toupper(static_cast<unsigned char>(argument[i + 1])) != letters[i]) return false;
    return true;
}

bool is_option(const std::string& argument) {
    return argument.size() > 1 && (argument[0] == '-' || argument[0] == '+');
}

// +Q0 .. +Q4 leave out shadows or textures; of ours, draft is the nearest.
std::string quality_of(const std::string& value) {
    return std::atoi(value.c_str()) <= 4 ? "draft" : "normal";
}

// One argument that starts with '+'.
void translate_plus(const std::string& argument, Frames& frames, std::vector<std::string>& ours) {
    const auto value_after = [&](const char* letters) {
        return argument.substr(1 + std::string(letters).size());
    };
    static constexpr std::pair<const char*, std::string Frames::*> frame_switches[] = {
        {"KFI", &Frames::first},      {"KFF", &Frames::last},       {"SF", &Frames::subset_first},
        {"EF", &Frames::subset_last}, {"KI", &Frames::clock_first}, {"KF", &Frames::clock_last}};
    for (const auto& [letters, member] : frame_switches)
        if (starts_with_letters(argument, letters)) {
            frames.*member = value_after(letters);
            return;
        }
    if (starts_with_letters(argument, "KC") && argument.size() == 3) {
        frames.cyclic = true;
    } else if (starts_with_letters(argument, "Q")) {
        ours.insert(ours.end(), {"--quality", quality_of(value_after("Q"))});
    } else if (starts_with_letters(argument, "A") && !starts_with_letters(argument, "AM")) {
        const std::string threshold = value_after("A");
        ours.insert(ours.end(), {"--antialias", threshold.empty() ? "0.3" : threshold});
    } else if (starts_with_letters(argument, "R") && !starts_with_letters(argument, "RP")) {
        ours.insert(ours.end(), {"--antialias-depth", value_after("R")});
    } else if (starts_with_letters(argument, "J")) {
        const std::string amount = value_after("J");
        ours.insert(ours.end(), {"--antialias-jitter", amount.empty() ? "1" : amount});
    } else {
        for (const Switch& known : switches) {
            if (!starts_with_letters(argument, known.letters)) continue;
            if (*known.ours != '\0') ours.emplace_back(known.ours);
            ours.push_back(value_after(known.letters));
            return;
        }
        const bool known =
            std::any_of(std::begin(meaningless), std::end(meaningless),
                        [&](const char* letters) { return starts_with_letters(argument, letters); });
        if (!known)
            throw UsageError(
                fmt::format("POV-Ray's option `{}` is not among those that pnr understands", argument));
    }
}

bool is_on(const std::string& value) { return value == "on" || value == "true" || value == "yes" || value == "1"; }

// Name=Value; false if it is no setting of POV-Ray's.
bool translate_setting(const std::string& argument, Frames& frames, std::vector<std::string>& ours) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || argument[0] == '-' || argument[0] == '+') return false;
    std::string name = argument.substr(0, equals), value = argument.substr(equals + 1), word = value;
    for (std::string* text : {&name, &word})
        for (char& c : *text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [known, option] : settings) {
        if (name != known) continue;
        if (*option != '\0') ours.emplace_back(option);
        ours.push_back(value);
        return true;
    }
    for (const auto& [known, member] : frame_settings)
        if (name == known) return frames.*member = value, true;
    if (name == "cyclic_animation") return frames.cyclic = is_on(word), true;
    if (name == "antialias" && !is_on(word)) return ours.insert(ours.end(), {"--antialias", "0"}), true;
    if (name == "antialias") return true;
    if (name == "antialias_threshold") return ours.insert(ours.end(), {"--antialias", value}), true;
    if (name == "quality") return ours.insert(ours.end(), {"--quality", quality_of(value)}), true;
    return std::find(std::begin(ignored_settings), std::end(ignored_settings), name) != std::end(ignored_settings);
}

// -A turns antialiasing off; of POV-Ray's other switches with a minus, those that mean nothing are dropped.
bool translate_minus(const std::string& argument, std::vector<std::string>& ours) {
    if (argument == "-A") {
        ours.insert(ours.end(), {"--antialias", "0"});
        return true;
    }
    if (argument == "-J") {
        ours.insert(ours.end(), {"--antialias-jitter", "0"});
        return true;
    }
    return argument.size() > 1 && argument[0] == '-' && argument != "-D" &&
           std::find(std::begin(meaningless), std::end(meaningless), argument.substr(1)) !=
               std::end(meaningless);
}

} // namespace

namespace {

// .ini files in place of their names.
std::vector<std::string> with_ini_files(const std::vector<std::string>& arguments) {
    std::vector<std::string> all;
    for (const std::string& argument : arguments) {
        if (!is_ini(argument)) {
            all.push_back(argument);
            continue;
        }
        for (std::string& setting : read_ini(argument)) {
            Frames ignored;
            std::vector<std::string> test;
            if (setting.find('=') != std::string::npos && !translate_setting(setting, ignored, test))
                throw UsageError(fmt::format("{}: POV-Ray has no setting `{}`, or pnr does not know it", argument, setting));
            all.push_back(std::move(setting));
        }
    }
    return all;
}

// Of what a file says and the command line says again, the last counts, as in POV-Ray.
void keep_last(std::vector<std::string>& ours) {
    for (const char* option : {"-W", "-H", "--threads", "--clock", "--antialias", "--quality"}) {
        bool seen = false;
        for (std::size_t i = ours.size(); i-- > 0;) {
            if (ours[i] != option || i + 1 >= ours.size()) continue;
            const auto at = ours.begin() + static_cast<std::ptrdiff_t>(i);
            if (seen) ours.erase(at, at + 2);
            seen = true;
        }
    }
}

void add_frames(const Frames& frames, std::vector<std::string>& ours) {
    if (!frames.last.empty()) ours.insert(ours.end(), {"--frames", frames.first + "-" + frames.last});
    if (!frames.subset_first.empty() || !frames.subset_last.empty())
        ours.insert(ours.end(), {"--subset", (frames.subset_first.empty() ? frames.first : frames.subset_first) + "-" +
                                                 (frames.subset_last.empty() ? frames.last : frames.subset_last)});
    if (!frames.clock_first.empty()) ours.insert(ours.end(), {"--clock-first", frames.clock_first});
    if (!frames.clock_last.empty()) ours.insert(ours.end(), {"--clock-last", frames.clock_last});
    if (frames.cyclic) ours.emplace_back("--cyclic");
}

} // namespace

std::vector<std::string> from_povray_options(std::vector<std::string> arguments) {
    std::vector<std::string> ours;
    Frames frames;
    const bool alone = !arguments.empty() && ((arguments[0].size() > 1 && arguments[0][0] == '+') || is_ini(arguments[0]));
    if (alone) ours.emplace_back("render");
    arguments = with_ini_files(arguments);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& argument = arguments[i];
        const bool last = i + 1 == arguments.size();
        if (argument == "-D") {
            if (last || is_option(arguments[i + 1]) || arguments[i + 1].find('=') == std::string::npos)
                continue;
            ours.push_back(argument);
            ours.push_back(arguments[++i]);
        } else if (argument.size() > 1 && argument[0] == '+' &&
                   std::isalpha(static_cast<unsigned char>(argument[1]))) {
            translate_plus(argument, frames, ours);
        } else if (translate_minus(argument, ours)) {
            continue;
        } else if (!translate_setting(argument, frames, ours)) {
            ours.push_back(argument);
        }
    }
    keep_last(ours);
    add_frames(frames, ours);
    return ours;
}

} // namespace pnr
