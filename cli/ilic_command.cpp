// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr ilic`: a flat picture, painted.
#include "cli/commands.h"

#include "cli/load.h"
#include "cli/passes.h"
#include "cli/picture_files.h"
#include "cli/report.h"
#include "core/atomic_file.h"
#include "core/image_io.h"
#include "npr/picture_ilic.h"

#include <fmt/format.h>

#include <cmath>

namespace pnr {

namespace {

namespace fs = std::filesystem;

PaintStyle style_of(const IlicOptions& words) {
    PaintStyle style = default_style();
    if (!words.style.empty() && !set_style(style, words.style)) {
        std::string known;
        for (const std::string& word : style_words()) known += (known.empty() ? "" : ", ") + word;
        throw UsageError(fmt::format("--style {}: one of {} is expected", words.style, known));
    }
    if (words.length) { // one coat of this length
        style.length = *words.length;
        for (PaintLayer& layer : style.layers) layer.length = *words.length;
    }
    if (words.cell) {
        style.cell = *words.cell;
        style.layers.clear();
    }
    if (words.size) style.size = *words.size;
    if (!style.gaussian_first) style.gaussian_first = 7, style.gaussian_second = 3; // the field is smooth already
    return style;
}

} // namespace

int run_ilic(const Options& options) {
    const ThreadLimit limit(options.threads);
    const fs::path input = options.ilic.picture;
    std::vector<fs::path> outputs = options.outputs;
    if (outputs.empty()) outputs = {input.stem().string() + "_painted.png"};
    for (const fs::path& output : outputs) check_output(output);
    const PaintStyle style = style_of(options.ilic);

    Passes passes(options.progress, true);
    const Image<glm::vec4> read = passes.run("parse", [&](const Progress&) { return read_image(input); });
    Image<Color> picture(read.width, read.height);
    for (std::size_t i = 0; i < read.pixels.size(); ++i) {
        const glm::vec4 pixel = read.pixels[i]; // what is transparent is painted in its own colour
        for (int c = 0; c < 3; ++c) picture.pixels[i][c] = pixel[c] > 0 && std::isfinite(pixel[c]) ? pixel[c] : 0;
    }
    const Image<Color> painted = passes.run("ilic", [&](const Progress& progress) {
        return paint_picture(picture, style, options.seed.value_or(RenderSettings{}.seed), progress);
    });
    passes.run("write", [&](const Progress&) {
        for (const fs::path& output : outputs) write_flat_picture(painted, output);
    });
    return exit_done;
}

} // namespace pnr
