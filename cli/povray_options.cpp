// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/povray_options.h"

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
// types, jitter.
constexpr const char* meaningless[] = {"UA", "UD", "UL", "UO", "UR", "UV", "AM", "BP", "BS", "GA", "GD",
                                       "GF", "GI", "GP", "GR", "GS", "GW", "HI", "MB", "MV", "RP", "SP",
                                       "EP", "XM", "B",  "C",  "D",  "F",  "J",  "P",  "R",  "V",  "X"};

// First and last frame, said apart (+KFI, +KFF).
struct Frames {
    std::string first = "1", last;
};

// Name=Value, in lower case, as in .ini files.
constexpr std::pair<const char*, const char*> settings[] = {
    {"width", "-W"},
    {"height", "-H"},
    {"output_file_name", "-o"},
    {"library_path", "-L"},
    {"work_threads", "--threads"},
    {"declare", "-D"},
    {"input_file_name", ""},
    {"display", nullptr},
    {"pause_when_done", nullptr},
    {"verbose", nullptr},
    {"output_alpha", nullptr},
    {"jitter", nullptr},
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
    if (starts_with_letters(argument, "KFI")) {
        frames.first = value_after("KFI");
    } else if (starts_with_letters(argument, "KFF")) {
        frames.last = value_after("KFF");
    } else if (starts_with_letters(argument, "Q")) {
        ours.insert(ours.end(), {"--quality", quality_of(value_after("Q"))});
    } else if (starts_with_letters(argument, "A") && !starts_with_letters(argument, "AM")) {
        const std::string threshold = value_after("A");
        ours.insert(ours.end(), {"--antialias", threshold.empty() ? "0.3" : threshold});
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

// Name=Value; false if it is no such setting.
bool translate_setting(const std::string& argument, std::vector<std::string>& ours) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || argument[0] == '-' || argument[0] == '+') return false;
    std::string name = argument.substr(0, equals);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto& [known, option] : settings) {
        if (name != known) continue;
        if (option == nullptr) return true;
        if (*option != '\0') ours.emplace_back(option);
        ours.push_back(argument.substr(equals + 1));
        return true;
    }
    return false;
}

// -A turns antialiasing off; of POV-Ray's other switches with a minus, those that mean nothing are dropped.
bool translate_minus(const std::string& argument, std::vector<std::string>& ours) {
    if (argument == "-A") {
        ours.insert(ours.end(), {"--antialias", "0"});
        return true;
    }
    return argument.size() > 1 && argument[0] == '-' && argument != "-D" &&
           std::find(std::begin(meaningless), std::end(meaningless), argument.substr(1)) !=
               std::end(meaningless);
}

} // namespace

std::vector<std::string> from_povray_options(std::vector<std::string> arguments) {
    std::vector<std::string> ours;
    Frames frames;
    if (!arguments.empty() && arguments[0].size() > 1 && arguments[0][0] == '+') ours.emplace_back("render");
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
        } else if (!translate_setting(argument, ours)) {
            ours.push_back(argument);
        }
    }
    if (!frames.last.empty()) ours.insert(ours.end(), {"--frames", frames.first + "-" + frames.last});
    return ours;
}

} // namespace pnr
