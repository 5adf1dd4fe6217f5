// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/converge.h"

#include "core/rng.h"
#include "parser/load_scene.h"
#include "run_pnr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace pnr {
namespace {

constexpr int side = 64;

// A constant with noise of this standard deviation in each channel.
Image<Color> noisy(float value, double deviation, std::uint64_t seed) {
    Image<Color> image(side, side, Color(value));
    Rng rng = make_rng(seed, Pass::test, 0);
    for (Color& c : image.pixels)
        for (int k = 0; k < 3; ++k)
            c[k] += static_cast<float>(deviation * std::sqrt(12.0) * (rng.uniform() - 0.5));
    return image;
}
const Image<float> everything(side, side, 1.0f);

TEST(PictureError, KnowsTheNoiseOfThePictureAlone) {
    // The references are four times as noisy as the picture.
    const Reference reference{noisy(2, 0.4, 1), noisy(2, 0.4, 2)};
    const PictureError error = picture_error(noisy(2, 0.1, 3), reference, everything);
    EXPECT_NEAR(error.rmse, 0.1, 0.02);
    EXPECT_NEAR(error.mean_ratio, 1, 0.01);
}

TEST(PictureError, OfABiasedPicture) {
    const Image<Color> truth(side, side, Color(2));
    const PictureError error =
        picture_error(Image<Color>(side, side, Color(2.2f)), {truth, truth}, everything);
    EXPECT_NEAR(error.rmse, 0.2, 1e-6);
    EXPECT_NEAR(error.relative_rmse, 0.2 / std::sqrt(4 + 0.04), 1e-6);
    EXPECT_NEAR(error.mean_ratio, 1.1, 1e-6);
    EXPECT_NEAR(error.relative_99, 0.2 / 2.2, 1e-6);
    EXPECT_EQ(picture_error(truth, {truth, truth}, everything).flip, 0);
    EXPECT_EQ(error.flip, 0) << "both are shown as white";
}

TEST(PictureError, LooksAtTheMaskAlone) {
    const Image<Color> truth(side, side, Color(1));
    Image<Color> picture = truth;
    Image<float> mask = everything;
    picture.at(3, 4) = Color(100);
    mask.at(3, 4) = 0;
    EXPECT_EQ(picture_error(picture, {truth, truth}, mask).rmse, 0);
    EXPECT_THROW(picture_error(picture, {truth, truth}, Image<float>(side, side, 0.0f)),
                 std::invalid_argument);
    EXPECT_THROW(picture_error(picture, {truth, Image<Color>(2, 2)}, mask), std::invalid_argument);
}

TEST(LogSlope, IsThePower) {
    std::vector<std::pair<double, double>> points{{0, 1}, {1, 0}};
    EXPECT_FALSE(log_slope(points));
    for (double x = 1; x < 100; x *= 2) points.emplace_back(x, 3 / std::sqrt(x));
    ASSERT_TRUE(log_slope(points));
    EXPECT_NEAR(*log_slope(points), -0.5, 1e-12);
    EXPECT_FALSE(log_slope({{2, 1}, {2, 3}}));
}

TEST(Converge, PrintsATableAndWritesAPage) {
    const TemporaryFolder folder;
    folder.write("s.pnr", box_scene());
    const Ran ran = run_pnr(folder, {"converge", "s.pnr", "--size", "32x32", "--budgets", "0.2,0.6,1.2",
                                     "--reference-time", "1", "--causes", "--csv", "t.csv", "--html", "page.html",
                                     "--progress", "off"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("relative_rmse"), std::string::npos);
    EXPECT_TRUE(folder.read("t.csv").starts_with("setting,budget_s,wall_s,cpu_s"));
    EXPECT_NE(ran.out.find("field_degrees"), std::string::npos);
    const std::string page = folder.read("page.html");
    EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);
}

Settings small_settings(const LoadResult& loaded, std::uint64_t seed) {
    Settings settings = loaded.settings;
    settings.render.width = settings.render.height = 40;
    settings.render.seed = seed;
    settings.photons.count = 20'000;
    return settings;
}

// Variances of independent causes add up to that of the whole, which two independent runs tell.
TEST(Converge, CausesAddUp) {
    std::string text = box_scene();
    const std::size_t paint = text.find("npr {"), end = text.find("} } } }", paint) + 5;
    text.erase(paint, end - paint); // painted borders are other pixels with other seeds
    const LoadResult loaded = load_scene_text(text, "s.pnr", {});
    ASSERT_TRUE(loaded.scene);
    std::vector<Snapshot> run =
        run_budgets(*loaded.scene, small_settings(loaded, 1), {}, {0.8}, ProgressMode::off);
    add_causes(*loaded.scene, small_settings(loaded, 1), {}, run, ProgressMode::off);
    ASSERT_TRUE(run[0].photon_noise && run[0].sample_noise);
    EXPECT_GT(*run[0].photon_noise, 0);
    EXPECT_GT(*run[0].sample_noise, 0);
    Wishes wishes;
    wishes.refinement = Refinement{{}, {}, run[0].passes};
    Reuse kept;
    Passes passes(ProgressMode::off, false);
    const Rendering other = render_scene(*loaded.scene, small_settings(loaded, 2), wishes, kept, passes);
    Image<Color> middle = other.rendered.layer.color;
    for (std::size_t i = 0; i < middle.pixels.size(); ++i)
        middle.pixels[i] = 0.5f * (middle.pixels[i] + run[0].photoreal.pixels[i]);
    const double half = picture_error(run[0].photoreal, {middle, middle}, run[0].mask).relative_rmse;
    const double parts = *run[0].photon_noise * *run[0].photon_noise + *run[0].sample_noise * *run[0].sample_noise;
    EXPECT_NEAR(parts / (2 * half * half), 1, 0.3);
}

// The same seeds give the same bits, so that nothing but the cause that is changed changes.
TEST(Converge, SamplesOfTheSameSeedAreTheSame) {
    const LoadResult loaded = load_scene_text(box_scene(), "s.pnr", {});
    Wishes wishes;
    wishes.refinement = Refinement{{}, {}, 5};
    const auto picture = [&] {
        Reuse kept;
        Passes passes(ProgressMode::off, false);
        return render_scene(*loaded.scene, small_settings(loaded, 3), wishes, kept, passes).picture.color.pixels;
    };
    const auto plain = picture();
    wishes.sample_seed = 3;
    EXPECT_EQ(picture(), plain);
    wishes.sample_seed = 4;
    EXPECT_NE(picture(), plain);
}

// More photons lie nearer to each pixel: its axis and colour come from less far.
TEST(Converge, PaintsMapsGetBetterWithPhotons) {
    const LoadResult loaded = load_scene_text(box_scene(), "s.pnr", {});
    Settings settings = small_settings(loaded, 1);
    settings.render.width = settings.render.height = 96;
    const std::vector<PaintCauses> causes = paint_causes(*loaded.scene, settings);
    ASSERT_EQ(causes.size(), 3u);
    EXPECT_LT(causes[2].field, 0.8 * causes[0].field);
    EXPECT_LT(causes[2].map, causes[0].map);
    for (const PaintCauses& c : causes) {
        EXPECT_GT(c.field, 0);
        EXPECT_GT(c.ilic, 0);
        EXPECT_LT(c.ilic, 0.1);
    }
}

TEST(Converge, ComparesSettings) {
    const TemporaryFolder folder;
    folder.write("s.pnr", box_scene());
    const Ran ran = run_pnr(folder, {"converge", "s.pnr", "--size", "24x24", "--budgets", "0.3", "--sweep",
                                     "photons=1000,20000", "--progress", "off"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("photons=1000"), std::string::npos);
    EXPECT_NE(ran.out.find("photons=20000"), std::string::npos);
    EXPECT_EQ(run_pnr(folder, {"converge", "s.pnr", "--sweep", "photos=1"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"converge", "s.pnr", "--sweep", "photons"}).code, 2);
    EXPECT_EQ(run_pnr(folder, {"converge", "s.pnr", "--budgets", "2,1"}).code, 2);
}

} // namespace
} // namespace pnr
