// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/load.h"

#include "cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <unistd.h>

namespace pnr {

namespace {

namespace fs = std::filesystem;

LoadOptions load_options(const Options& options, const AnimationFrame& frame) {
    LoadOptions load;
    load.clock = frame.clock;
    load.frame_number = frame.number;
    load.initial_frame = frame.first;
    load.final_frame = frame.last;
    if (options.frames) {
        load.initial_clock = options.clock_first;
        load.final_clock = options.clock_last;
    }
    load.library = options.library;
    if (const char* path = std::getenv("PNR_LIBRARY_PATH")) {
        const std::string folders(path);
        for (std::size_t begin = 0; begin < folders.size();) {
            const std::size_t end = std::min(folders.find(':', begin), folders.size());
            if (end > begin) load.library.emplace_back(folders.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    load.declares = options.declares;
    load.budgets = options.budgets;
    load.allow_write = options.allow_write;
    load.width = options.width;
    load.height = options.height;
    return load;
}

void check_readable(const std::string& name) {
    std::error_code ignored;
    const auto refuse = [&](const std::string& why) {
        throw FileError(fmt::format("cannot read the scene `{}`: {}", name, why));
    };
    if (!fs::exists(name, ignored)) refuse("no such file");
    if (fs::is_directory(name, ignored)) refuse("it is a folder");
    // A pipe that nobody writes to is waited for without an end; those in /dev are the shell's own.
    if (fs::is_fifo(name, ignored) && !name.starts_with("/dev/") && !name.starts_with("/proc/")) refuse("it is a pipe");
    if (::access(name.c_str(), R_OK) != 0) refuse("permission denied");
}

// Rays a pixel, shadow rays a light, and photons where the scene does not say how many.
void apply_quality(Settings& settings, Quality quality) {
    RenderSettings& render = settings.render;
    if (!settings.photons.count_given) {
        if (quality == Quality::draft) settings.photons.count /= 2;
        if (quality == Quality::high) settings.photons.count *= 2;
    }
    if (quality == Quality::draft) {
        render.sharp = false;
        render.gather_effort = -1;
        render.samples_min = 1;
        render.samples_max = 4;
        render.contrast = std::max(render.contrast, 0.1); // the noise of few shadow rays is no edge
        render.shadow_samples = 4;
        render.grid.depth = 0;
    } else if (quality == Quality::high) {
        render.gather_effort = 2;
        render.samples_min = 16;
        render.samples_max = 64;
        render.shadow_samples = 64;
        render.grid.depth = 5;
        render.grid.threshold = 0.1;
    }
}

} // namespace

std::vector<AnimationFrame> frames_of(const Options& options) {
    if (!options.frames) {
        AnimationFrame only;
        only.clock = options.clock;
        return {only};
    }
    const FrameRange& range = *options.frames;
    std::vector<AnimationFrame> frames;
    const int steps = range.last - range.first + (options.cyclic ? 1 : 0);
    const FrameRange& wanted = options.subset ? *options.subset : range;
    const double length = options.clock_last - options.clock_first;
    for (int number = wanted.first; number <= wanted.last; number += wanted.step) {
        if (number < range.first || number > range.last) continue;
        const double share = steps > 0 ? static_cast<double>(number - range.first) / steps : 0;
        frames.push_back({number, range.first, range.last, options.clock_first + length * share});
    }
    return frames;
}

fs::path numbered(const fs::path& file, int frame) {
    std::string name = file.filename().string();
    const std::size_t begin = name.find('#');
    if (begin != std::string::npos) {
        const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
        name.replace(begin, end - begin, fmt::format("{:0{}}", frame, end - begin));
        return file.parent_path() / name;
    }
    return file.parent_path() /
           fmt::format("{}{:04}{}", file.stem().string(), frame, file.extension().string());
}

LoadResult load_named_scene(const std::string& name, const Options& options, const AnimationFrame& frame) {
    const LoadOptions load = load_options(options, frame);
    if (name.empty()) return load_scene_text(default_scene_text(), "default.pnr", load);
    if (name == "-") {
        std::string text(std::istreambuf_iterator<char>(std::cin), {});
        return load_scene_text(std::move(text), "<stdin>", load);
    }
    check_readable(name);
    return load_scene(name, load);
}

bool load_and_report(const Options& options, const AnimationFrame& frame, LoadResult& loaded) {
    loaded = load_named_scene(scene_name(options), options, frame);
    if (!loaded.debug_output.empty()) std::fputs(loaded.debug_output.c_str(), stderr);
    print_diagnostics(loaded.diagnostics, loaded.sources);
    if (may_render(loaded, options)) return true;
    if (loaded.scene) print_error("warnings count as errors (--werror)");
    return false;
}

std::string scene_name(const Options& options) {
    return options.scenes.empty() ? "" : options.scenes.front();
}

bool may_render(const LoadResult& loaded, const Options& options) {
    const bool warned = std::any_of(loaded.diagnostics.begin(), loaded.diagnostics.end(),
                                    [](const Diagnostic& d) { return d.severity == Severity::warning; });
    return loaded.scene.has_value() && !(options.werror && warned);
}

Settings merge_settings(const Settings& scene, const Options& options) {
    Settings settings = scene;
    RenderSettings& render = settings.render;
    if (options.width || options.height) { // one side alone: the other follows the camera
        render.width = options.width.value_or(0);
        render.height = options.height.value_or(0);
    }
    if (options.seed) render.seed = *options.seed;
    if (options.exposure) render.exposure = *options.exposure;
    if (options.view) render.view = *options.view;
    if (options.quality) apply_quality(settings, *options.quality);
    if (options.integrator) render.integrator = *options.integrator;
    if (options.antialias) {
        render.contrast = *options.antialias;
        render.grid.threshold = *options.antialias;
        if (*options.antialias <= 0) render.samples_min = render.samples_max = 1, render.grid.depth = 0;
    }
    if (options.antialias_depth && render.grid.depth > 0) render.grid.depth = *options.antialias_depth;
    if (options.antialias_jitter) render.grid.jitter = *options.antialias_jitter;
    if (!options.prune) render.prune = false;
    return settings;
}

std::string scene_stem(const std::string& name) {
    if (name.empty()) return "default";
    if (name == "-") return "stdin";
    return fs::path(name).stem().string();
}

} // namespace pnr
