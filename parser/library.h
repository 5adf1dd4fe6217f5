// SPDX-License-Identifier: GPL-3.0-or-later
// Where files are looked for, and which may be read: the folder of the including file, of the scene, the
// library, our own includes (embedded), POV-Ray's installed includes. Nothing outside of these folders is
// opened.
#pragma once

#include "parser/expander.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pnr {

struct EmbeddedFile {
    std::string_view name; // "colors.inc"
    std::string_view text;
};
const std::vector<EmbeddedFile>& embedded_files(); // written by the build (embed.cmake)

// The number of the source with this file's text, read and added when it is new. Error at `at` if there is
// none.
std::uint32_t open_include(Parser& p, const Token& at, const std::string& name);

// A whole text, at most `most` bytes of it and one more: who gets that knows that it is too long. Nothing if it
// cannot be read.
std::optional<std::string> read_text(const std::string& path, std::size_t most);

// Where a file that the scene writes lands on disk: below LoadOptions::allow_write. Empty: it stays in memory.
std::filesystem::path writable_path(const Expander& in, const std::string& name);
// Writes all that #fopen opened for writing and that may be written. Throws FileError.
void write_files(const Expander& in);

// The library's file that declares this name, a variable or a macro, "colors.inc"; empty: none, or it is read
// already.
std::string include_that_declares(const Parser& p, std::string_view name);

bool file_exists(Parser& p, const std::string& name);

// Folders of POV-Ray's includes on this machine, e.g. /usr/share/povray-3.7/include; newest first.
std::vector<std::filesystem::path> povray_folders();

} // namespace pnr
