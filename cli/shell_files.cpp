// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace pnr {

namespace {

// An option as shells see it.
struct Flag {
    std::vector<std::string> names;   // "-o", "--view"; none: a word at its place
    std::string value;                // "N"; empty: it takes none
    std::vector<std::string> choices; // all values there are, if they are few
    std::string text;
};
struct Command {
    std::string name, text, footer, usage;
    std::vector<Flag> flags, places;
};

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

// "clip|shoulder" names its values.
std::vector<std::string> choices_of(const std::string& type) {
    const bool words = std::all_of(type.begin(), type.end(),
                                   [](unsigned char c) { return std::islower(c) != 0 || c == '|'; });
    return words && type.find('|') != std::string::npos ? split(type, '|') : std::vector<std::string>{};
}

Flag flag_of(const CLI::Option& option) {
    Flag flag;
    for (const std::string& name : option.get_snames()) flag.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) flag.names.push_back("--" + name);
    if (option.get_items_expected_max() > 0) {
        const std::string type = option.get_type_name();
        flag.choices = choices_of(type);
        flag.value = flag.names.empty() ? option.get_name() : type.substr(0, type.find(':'));
    }
    flag.text = option.get_description();
    return flag;
}

std::vector<Command> commands_of(const CLI::App& app) {
    std::vector<Command> commands;
    for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
        Command command{each->get_name(), each->get_description(), each->get_footer(), {}, {}, {}};
        for (const CLI::Option* option : each->get_options()) {
            if (option->get_group().empty()) continue; // hidden
            const Flag flag = flag_of(*option);
            (flag.names.empty() ? command.places : command.flags).push_back(flag);
        }
        commands.push_back(std::move(command));
    }
    return commands;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return names;
}

// In quotes of a shell: the letter `quote` may not stand inside.
std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

// ---- the manual page ----

// A minus is a minus, a backslash a backslash, and no line begins with a command of troff.
std::string troff(const std::string& text) {
    std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    if (!safe.empty() && (safe[0] == '.' || safe[0] == '\'')) safe = "\\&" + safe;
    return replaced(replaced(safe, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

std::string man_flag(const Flag& flag) {
    std::vector<std::string> names;
    for (const std::string& name : flag.names) names.push_back("\\fB" + troff(name) + "\\fR");
    std::string head = joined(names, ", ");
    if (!flag.value.empty()) head += (head.empty() ? "" : " ") + ("\\fI" + troff(flag.value) + "\\fR");
    return fmt::format(".TP\n{}\n{}\n", head, troff(flag.text));
}

std::string man_command(const Command& command) {
    std::string places;
    for (const Flag& place : command.places) places += " \\fI" + troff(place.value) + "\\fR";
    std::string text = fmt::format(
        ".SH \"PNR {}\"\n{}.\n.PP\n\\fBpnr {}\\fR [\\fIoptions\\fR]{}\n",
        [&] {
            std::string upper = command.name;
            std::transform(upper.begin(), upper.end(), upper.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
            return upper;
        }(),
        troff(command.text), troff(command.name), places);
    for (const Flag& place : command.places) text += man_flag(place);
    for (const Flag& flag : command.flags) text += man_flag(flag);
    if (!command.footer.empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", troff(command.footer));
    return text;
}

// ---- shells ----

std::string zsh_flag(const Flag& flag) {
    std::string text = replaced(replaced(replaced(flag.text, "'", ""), "[", "("), "]", ")");
    text = replaced(text, ":", ",");
    std::string value;
    if (!flag.value.empty())
        value = flag.choices.empty() ? fmt::format(":{}:_files", replaced(flag.value, ":", ","))
                                     : fmt::format(":value:({})", joined(flag.choices, " "));
    std::string lines;
    for (const std::string& name : flag.names)
        lines += fmt::format("                '*{}[{}]{}' \\\n", name, text, value);
    return lines;
}

std::string fish_quoted(const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

std::string fish_flag(const Command& command, const Flag& flag) {
    std::string line = fmt::format("complete -c pnr -n '__fish_seen_subcommand_from {}'", command.name);
    for (const std::string& name : flag.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!flag.choices.empty())
        line += fmt::format(" -x -a '{}'", joined(flag.choices, " "));
    else if (!flag.value.empty())
        line += " -r";
    return fmt::format("{} -d {}\n", line, fish_quoted(flag.text));
}

} // namespace

std::string bash_completion(const CLI::App& app) {
    const std::vector<Command> commands = commands_of(app);
    std::string options, values;
    for (const Command& command : commands) {
        std::vector<std::string> names;
        for (const Flag& flag : command.flags) {
            names.insert(names.end(), flag.names.begin(), flag.names.end());
            for (const std::string& name : flag.names)
                if (!flag.choices.empty())
                    values += fmt::format("        '{} {}') words='{}' ;;\n", command.name, name,
                                          joined(flag.choices, " "));
        }
        options += fmt::format("        {}) options='{}' ;;\n", command.name, joined(names, " "));
    }
    const std::string all = joined(names_of(commands), " ");
    return fmt::format(R"(# pnr completion for bash; made by `pnr completions bash`
_pnr() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} options= words=
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W '{0} --help --version' -- "$current"))
        return
    fi
    case "$command" in
{1}    esac
    case "$command ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{2}        'help help') words='{0}' ;;
        'completions completions') words='bash zsh fish' ;;
    esac
    if [ -n "$words" ]; then
        COMPREPLY=($(compgen -W "$words" -- "$current"))
    elif [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
    else
        COMPREPLY=($(compgen -f -- "$current"))
    fi
}}
complete -o filenames -F _pnr pnr
)",
                       all, options, values);
}

std::string zsh_completion(const CLI::App& app) {
    std::string described, cases;
    for (const Command& command : commands_of(app)) {
        described += fmt::format("        '{}:{}'\n", command.name,
                                 replaced(replaced(command.text, "'", ""), ":", ","));
        cases += fmt::format("        {})\n            _arguments \\\n", command.name);
        for (const Flag& flag : command.flags) cases += zsh_flag(flag);
        cases += "                '*:file:_files' ;;\n";
    }
    return fmt::format(R"(#compdef pnr
# pnr completion for zsh; made by `pnr completions zsh`
_pnr() {{
    local -a commands
    commands=(
{}    )
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    local command=$words[2]
    shift words
    ((CURRENT--))
    case $command in
{}    esac
}}
if [ "$funcstack[1]" = "_pnr" ]; then
    _pnr "$@"
else
    compdef _pnr pnr
fi
)",
                       described, cases);
}

std::string fish_completion(const CLI::App& app) {
    std::string text = "# pnr completion for fish; made by `pnr completions fish`\n";
    for (const Command& command : commands_of(app)) {
        text += fmt::format("complete -c pnr -f -n __fish_use_subcommand -a {} -d {}\n", command.name,
                            fish_quoted(command.text));
        for (const Flag& flag : command.flags) text += fish_flag(command, flag);
    }
    return text;
}

std::string man_page(const CLI::App& app, const std::string& version) {
    std::string described = app.get_description(); // "pnr renders ..."
    if (described.starts_with("pnr ")) described.erase(0, 4);
    if (described.ends_with('.')) described.pop_back();
    std::string text = fmt::format(
        ".TH PNR 1 \"\" \"pnr {}\" \"User Commands\"\n.SH NAME\npnr \\- {}\n"
        ".SH SYNOPSIS\n\\fBpnr\\fR \\fIcommand\\fR [\\fIoptions\\fR] [\\fIfile\\fR ...]\n.SH COMMANDS\n",
        troff(version), troff(described));
    const std::vector<Command> commands = commands_of(app);
    for (const Command& command : commands)
        text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(command.name), troff(command.text));
    for (const Command& command : commands) text += man_command(command);
    return text + fmt::format(".SH \"EXIT STATUS\"\n{}\n", troff(app.get_footer()));
}

} // namespace pnr
