// SPDX-License-Identifier: GPL-3.0-or-later
// What the command line said. Everything that the scene can say too is optional here: unset leaves the
// scene's word.
#pragma once

#include "core/image.h"
#include "core/settings.h"
#include "parser/limits.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pnr {

enum class ProgressMode { automatic, off, json };
enum class TextFormat { text, json };

// --crop as said: pixels from the top left, the last two exclusive, or fractions of the picture when none is
// above 1.
using CropWord = std::array<double, 4>;

struct FrameRange {
    int first = 1, last = 1, step = 1;
};

// What --quality changes: rays a pixel and shadow rays a light (apply_quality in load.cpp).
enum class Quality { draft, normal, high };

// Of `pnr ilic`; unset: the style's own.
struct IlicOptions {
    std::string picture, style;
    std::optional<double> length, cell, size;
};

struct Options {
    std::string command;                        // render, watch, check, plan, pick, ilic, stability, converge, fmt, init, lsp
    std::vector<std::string> scenes;            // empty: the embedded default scene; "-": standard input
    std::vector<std::filesystem::path> outputs; // "-": PNG to standard output
    std::optional<int> width, height;
    int threads = 0; // 0: as many as the machine gives
    std::optional<std::uint64_t> seed;
    std::vector<std::pair<std::string, std::string>> declares;
    std::vector<std::filesystem::path> library;
    Budgets budgets; // --limit
    std::filesystem::path allow_write; // #fopen may write files below it; empty: nowhere
    std::optional<CropWord> crop;
    std::optional<FrameRange> frames;
    std::optional<FrameRange> subset;      // of the frames, those that are rendered
    double clock = 0;                      // of a single picture
    double clock_first = 0, clock_last = 1; // over the frames
    bool cyclic = false; // the frame behind the last one would be the first again: the clock stops short of its end
    std::optional<double> exposure;
    std::optional<View> view;
    std::optional<Quality> quality;
    std::optional<Integrator> integrator;
    std::optional<double> antialias; // POV-Ray's +A threshold; 0: one sample a pixel
    std::optional<int> antialias_depth;     // +R: its grid's side
    std::optional<double> antialias_jitter; // +J: how far its points stray, 1 at most
    std::filesystem::path maps, stats, save_photons, load_photons; // empty: not asked for
    std::vector<std::string> aovs;
    std::string tev;                // HOST:PORT of a viewer; empty: none
    std::vector<std::string> shows; // kinds of pictures in place of the scene's own
    std::optional<double> time_s, error; // --time, --error (a fraction)
    std::optional<int> passes;
    ProgressMode progress = ProgressMode::automatic;
    bool prune = true, skip_existing = false, no_overwrite = false, werror = false;
    TextFormat format = TextFormat::text;
    bool cache = true;       // results of earlier runs may be used again, and are kept
    bool check_only = false; // fmt: write nothing
    IlicOptions ilic;
    std::array<int, 2> at{}; // pick: pixels
    std::optional<std::array<int, 2>> to;
    std::vector<std::string> groups; // stability: these alone; empty: all
    std::filesystem::path graph; // plan: drawn there; empty: not
    std::filesystem::path html, csv; // the report as a page, as a table; empty: not asked for
    // converge
    std::vector<double> run_budgets; // s, rising
    std::filesystem::path reference; // a picture; empty: path traced
    double reference_s = 0;          // for so long; 0: no reference
    bool causes = false;             // split the error by cause
    std::string sweep;               // a setting and its values
    std::vector<double> sweep_values;
};

// The command line cannot be understood (exit code 2).
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Either options to act on, or a text to print (help, version) and leave with 0.
struct CommandLine {
    Options options;
    std::string answer;
};

// Arguments without the program's name. Throws UsageError.
CommandLine parse_command_line(std::vector<std::string> arguments);

// The crop in pixels of a picture of this size. Throws UsageError if it is empty or leaves the picture.
PixelRect crop_window(const std::optional<CropWord>& crop, int width, int height);

const char* version();

} // namespace pnr
