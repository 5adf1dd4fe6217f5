// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/pattern_assets.h"

#include "core/image_io.h"

#include <cmath>

namespace pnr {

namespace {

// What the reader has to say against a file is an error where the scene names it.
template <class F>
auto read_at(const SourceRef& said_at, F read) {
    try {
        return read();
    } catch (const FileError& problem) {
        throw SceneError(said_at, problem.what());
    }
}

// In the scene's working values.
Image<glm::vec4> read_working(const ImagePattern& said, double assumed_gamma) {
    Image<glm::vec4> picture = read_at(said.said_at, [&] { return read_image(said.file); });
    for (glm::vec4& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) {
            float linear = pixel[c];
            if (said.file_gamma > 0)
                linear = std::pow(std::max(0.f, srgb_encode(linear)), static_cast<float>(said.file_gamma));
            pixel[c] =
                working_from_linear(linear, said.as_stored ? 0 : assumed_gamma); // 0: the file's own values
        }
    return picture;
}

void read_picture(ImagePattern& said, PatternAssets& assets) {
    if (said.image) return;
    auto& entry = assets.pictures[{said.file, said.as_stored, said.file_gamma}];
    if (!entry) entry = std::make_shared<const Image<glm::vec4>>(read_working(said, assets.assumed_gamma));
    if (entry->empty()) throw SceneError(said.said_at, "the picture is empty");
    said.image = entry;
}

void read_density(DensityFilePattern& said, PatternAssets& assets) {
    if (said.grid) return;
    auto& entry = assets.densities[said.file];
    if (!entry) entry = std::make_shared<const DensityGrid>(read_at(said.said_at, [&] { return read_density_grid(said.file); }));
    said.grid = entry;
}

} // namespace

void prepare_pattern(Pattern& pattern, PatternAssets& assets) {
    if (pattern.noise_generator == 0) pattern.noise_generator = assets.noise_generator;
    if (pattern.number_of_waves == 0) pattern.number_of_waves = assets.number_of_waves;
    if (auto* picture = std::get_if<ImagePattern>(&pattern.kind)) read_picture(*picture, assets);
    if (auto* density = std::get_if<DensityFilePattern>(&pattern.kind)) read_density(*density, assets);
    if (auto* inner = std::get_if<PigmentPattern>(&pattern.kind)) {
        Pigment pigment = *inner->pigment;
        prepare_pigment(pigment, assets);
        inner->pigment = std::make_shared<const Pigment>(std::move(pigment));
    }
}

void prepare_pigment(Pigment& pigment, PatternAssets& assets) {
    prepare_pattern(pigment.pattern, assets);
    for (auto& entry : pigment.pigments) prepare_pigment(entry.value, assets);
}

} // namespace pnr
