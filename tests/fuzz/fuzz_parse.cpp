// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry to the parser: any bytes are a scene or are refused at a place. The budgets are small, so that
// a run is short; a scene with an error has none, one without has all. tests/fuzz/run builds and runs it;
// `fuzz_parse --dictionary` prints the language's words for libFuzzer's -dict.
#include "parser/keywords.h"
#include "parser/load_scene.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

using namespace pnr;

LoadOptions options() {
    LoadOptions options;
    options.budgets.loop_turns = 2'000;
    options.budgets.macro_calls = 2'000;
    options.budgets.tokens = 200'000;
    options.budgets.bytes = 64'000'000;
    options.budgets.array_elements = 100'000;
    options.budgets.string_length = 100'000;
    options.budgets.failures = 200;
    return options;
}

void require(bool truth, const char* what) {
    if (truth) return;
    std::fprintf(stderr, "fuzz_parse: %s\n", what);
    std::abort();
}

void feed(const std::uint8_t* data, std::size_t size) {
    // The first byte chooses between the two dialects.
    const bool povray = size > 0 && data[0] % 2 == 1;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const LoadResult result = load_scene_text(text, povray ? "fuzz.pov" : "fuzz.pnr", options());
    const bool failed = std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                                    [](const Diagnostic& d) { return d.severity == Severity::error; });
    require(failed != result.scene.has_value(), "an error and a scene, or neither");
    for (const Diagnostic& d : result.diagnostics) {
        require(d.span.source < result.sources.files.size(), "a diagnostic without a place");
        require(d.span.begin <= result.sources.files[d.span.source].text.size(), "a place outside of the text");
        require(!format(d, result.sources, true).empty(), "a diagnostic without words");
    }
    require(!format_json(result.diagnostics, result.sources).empty(), "no JSON");
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    if (*argc != 2 || std::strcmp((*argv)[1], "--dictionary") != 0) return 0;
    for (Symbol s = 0; s < keyword_count; ++s) {
        const std::string_view word = keyword_text(static_cast<Keyword>(s));
        std::printf("\"%.*s\"\n", static_cast<int>(word.size()), word.data());
    }
    for (const char* sign : {"<=", ">=", "!=", "#", "/*", "*/", "//", "\\\"", "{", "}", "<0,0,0>", "1e30", "(", ")"})
        std::printf("\"%s\"\n", sign);
    for (const char* word : {"declare", "local", "macro", "while", "for", "if", "ifdef", "switch", "case", "range",
                             "break", "end", "else", "elseif", "include", "default", "version", "fopen", "fclose",
                             "read", "write", "undef"})
        std::printf("\"#%s \"\n", word);
    std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    feed(data, size);
    return 0;
}
