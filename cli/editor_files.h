// SPDX-License-Identifier: GPL-3.0-or-later
// The language's words as editors colour them: grammar/editors holds what these give.
#pragma once

#include <string>

namespace pnr {

std::string vim_syntax();
std::string textmate_grammar(); // JSON, for VS Code and others

// "vim" or "textmate": the file of grammar/editors of that editor.
std::string editor_file(const std::string& editor);

} // namespace pnr
