// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/ini_file.h"

#include "cli/options.h"
#include "core/types.h"

#include <fmt/format.h>

#include <cctype>
#include <fstream>

namespace pnr {

namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n\"");
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r\n\"") - begin + 1);
}

// `file.ini[section]` in two.
std::pair<std::string, std::string> split_section(const std::string& argument) {
    const std::size_t open = argument.rfind('[');
    if (argument.empty() || argument.back() != ']' || open == std::string::npos) return {argument, {}};
    return {argument.substr(0, open), argument.substr(open + 1, argument.size() - open - 2)};
}

void add_switches(const std::string& line, std::vector<std::string>& settings) {
    for (std::size_t begin = line.find_first_not_of(" \t"); begin < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
        settings.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(" \t", end);
    }
}

} // namespace

bool is_ini(const std::string& argument) {
    return argument.size() > 4 && argument[0] != '-' && argument[0] != '+' &&
           argument.find('=') == std::string::npos && lower(split_section(argument).first).ends_with(".ini");
}

std::vector<std::string> read_ini(const std::string& argument) {
    const auto [path, section] = split_section(argument);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw FileError(fmt::format("cannot read `{}`", path));
    std::vector<std::string> settings;
    bool wanted = true, found = section.empty();
    for (std::string line; std::getline(file, line);) {
        const std::size_t comment = line.find(';');
        line = trimmed(line.substr(0, comment));
        if (line.empty()) continue;
        if (line.front() == '[' && line.back() == ']') {
            wanted = lower(trimmed(line.substr(1, line.size() - 2))) == lower(section);
            found = found || wanted;
        } else if (wanted && (line.front() == '+' || line.front() == '-')) {
            add_switches(line, settings);
        } else if (wanted && line.find('=') != std::string::npos) {
            const std::size_t equals = line.find('=');
            settings.push_back(trimmed(line.substr(0, equals)) + "=" + trimmed(line.substr(equals + 1)));
        } else if (wanted) {
            settings.push_back(line); // the scene's name
        }
    }
    if (!found) throw UsageError(fmt::format("`{}` has no section [{}]", path, section));
    return settings;
}

} // namespace pnr
