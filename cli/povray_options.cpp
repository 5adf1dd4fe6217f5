// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/povray_options.h"

#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace pnr {

namespace {

// POV-Ray's switches, the longest first where one starts another [POV-Ray 3.7 reference, "Command-line and
// INI-file options"]. `ours`: our option that takes the value; empty: the switch means nothing here and is
// dropped.
struct Switch {
    const char* letters; // after + or -, upper case
    const char* ours;
    bool takes_value = false;
};
constexpr Switch switches[] = {
    {"WT", "--threads", true},
    {"UA", ""},
    {"UV", ""},
    {"UD", ""},
    {"UL", ""},
    {"UR", ""},
    {"UO", ""},
    {"UF", ""},
    {"AM", "", true},
    {"BP", "", true},
    {"BS", "", true},
    {"GA", "", true},
    {"GD", "", true},
    {"GF", "", true},
    {"GI", "", true},
    {"GR", "", true},
    {"GS", "", true},
    {"GW", "", true},
    {"HI", "", true},
    {"MB", "", true},
    {"MV", "", true},
    {"RP", "", true},
    {"SP", "", true},
    {"EP", "", true},
    {"XM", ""},
    {"W", "-W", true},
    {"H", "-H", true},
    {"O", "-o", true},
    {"L", "-L", true},
    {"J", "", true},
    {"R", "", true},
    {"F", "", true},
    {"B", "", true},
    {"D", "", true},
    {"C", ""},
    {"P", ""},
    {"V", ""},
    {"X", ""},
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
void translate_plus(const std::string& argument, std::vector<std::string>& ours) {
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(argument[1])));
    if (letter == 'I') {
        ours.push_back(argument.substr(2));
        return;
    }
    if (letter == 'Q') {
        ours.insert(ours.end(), {"--quality", quality_of(argument.substr(2))});
        return;
    }
    if (letter == 'A' && !starts_with_letters(argument, "AM")) {
        ours.insert(ours.end(), {"--antialias", argument.size() > 2 ? argument.substr(2) : "0.3"});
        return;
    }
    for (const Switch& known : switches) {
        if (!starts_with_letters(argument, known.letters)) continue;
        const std::string value = argument.substr(1 + std::string(known.letters).size());
        if (!known.takes_value && !value.empty()) continue;
        if (*known.ours != '\0') ours.insert(ours.end(), {known.ours, value});
        return;
    }
    throw UsageError(fmt::format("POV-Ray's option `{}` is not among those that pnr understands", argument));
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

// -A turns antialiasing off; the other switches that POV-Ray turns off with a minus mean nothing here.
bool translate_minus(const std::string& argument, std::vector<std::string>& ours) {
    static const char* const meaningless[] = {"-B", "-C",  "-F",  "-J",  "-P",  "-R", "-V",
                                              "-X", "-GA", "-UA", "-UD", "-UR", "-UV"};
    if (argument == "-A") {
        ours.insert(ours.end(), {"--antialias", "0"});
        return true;
    }
    return std::find(std::begin(meaningless), std::end(meaningless), argument) != std::end(meaningless);
}

} // namespace

std::vector<std::string> from_povray_options(std::vector<std::string> arguments) {
    std::vector<std::string> ours;
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
            translate_plus(argument, ours);
        } else if (translate_minus(argument, ours)) {
            continue;
        } else if (!translate_setting(argument, ours)) {
            ours.push_back(argument);
        }
    }
    return ours;
}

} // namespace pnr
