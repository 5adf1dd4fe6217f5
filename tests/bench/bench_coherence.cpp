// SPDX-License-Identifier: GPL-3.0-or-later
// How far strokes swim when the camera moves: an animation whose scene moves the camera by `clock`, painted
// three ways, each frame warped to the next by the known motion.
//
// bench_coherence SCENE [--frames N] [--height H] [--turn SHARE] [-L DIR]... [--pictures DIR] [--only-ours]
//   --only-ours: without the two it is compared with
//   --turn: the clock runs from 0 to SHARE over the frames; 1 is the scene's whole orbit
// Prints a row a way of painting: rms (display values, 0..1, over R, G, B), contrast (standard deviation of
// the strokes about a blurred copy), rms over contrast, and the pixels compared. Compared are pixels of one
// object that both frames show and that lie three pixels or more inside the silhouette in both. The ways
// [LW10 Fig. 12]: ours; Rendered-First-ILIC-Last (the photon-mapped picture painted in two dimensions, on the
// object's area); ILIC-First-Texture-Mapping-Last (a picture filtered by ILIC of length 60, wrapped round the
// object and lit). The noise of the other two is scaled until their contrast in the first frame is ours.

#include "core/gbuffer.h"
#include "core/image_io.h"
#include "core/irradiance_field.h"
#include "core/trace_photons.h"
#include "npr/color_space.h"
#include "npr/hidden_sources.h"
#include "npr/masked_blur.h"
#include "npr/paint.h"
#include "npr/picture_ilic.h"
#include "parser/load_scene.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <map>

namespace {

using namespace pnr;

struct Words {
    std::string scene, pictures;
    std::vector<std::filesystem::path> library;
    int frames = 24, height = 320;
    double turn = 1;
    bool only_ours = false;
};

// What one frame shows, and the light of its painted pixels without paint.
struct Shown {
    GBuffer gbuffer;
    Image<Color> photoreal;
    Image<std::uint8_t> mask, inner; // painted pixels seen directly; those three pixels or more inside
};

struct Shot {
    World world;
    Settings settings;
    PhotonMap photons;
    OrientationFields fields;
    std::vector<Vec3f> oriented;
};

World load_world(const Words& words, double clock, Settings& settings) {
    LoadOptions options;
    options.clock = clock;
    options.library = words.library;
    LoadResult loaded = load_scene(words.scene, options);
    if (!loaded.scene) {
        fmt::print(stderr, "{}: {}\n", words.scene,
                   loaded.diagnostics.empty() ? "no scene" : loaded.diagnostics.front().message);
        std::exit(3);
    }
    settings = loaded.settings;
    return build_world(*loaded.scene, settings);
}

Shot prepare(const Words& words) {
    Shot shot;
    shot.world = load_world(words, 0, shot.settings);
    shot.photons = trace_photons(shot.world, shot.settings.photons, shot.settings.render.seed, 0, true);
    build_photon_tree(shot.photons);
    shot.photons.field = make_irradiance_field(shot.world, shot.photons);
    shot.fields = make_orientation_fields(shot.world);
    shot.oriented = orient_photons(shot.world, shot.photons, shot.fields);
    return shot;
}

Image<std::uint8_t> eroded(const Image<std::uint8_t>& mask, int reach) {
    Image<std::uint8_t> inner(mask.width, mask.height, 0);
    for (int y = reach; y < mask.height - reach; ++y)
        for (int x = reach; x < mask.width - reach; ++x) {
            bool all = true;
            for (int j = -reach; j <= reach && all; ++j)
                for (int i = -reach; i <= reach && all; ++i)
                    all = i * i + j * j > reach * reach || mask.at(x + i, y + j) != 0;
            inner.at(x, y) = all ? 1 : 0;
        }
    return inner;
}

Shown see(const Shot& shot, const Words& words, double clock) {
    Shown frame;
    Settings settings;
    const Camera camera = load_world(words, clock, settings).camera;
    const double aspect = glm::length(camera.right) / glm::length(camera.up);
    const PictureView view{camera, static_cast<int>(std::lround(words.height * aspect)), words.height};
    frame.gbuffer = make_gbuffer(shot.world, view, {0, 0, view.width, view.height}, shot.settings.render);
    frame.mask = Image<std::uint8_t>(view.width, view.height, 0);
    for (std::size_t i = 0; i < frame.mask.pixels.size(); ++i)
        frame.mask.pixels[i] =
            is_painted(frame.gbuffer.seen.pixels[i]) && frame.gbuffer.seen.pixels[i].via == 0;
    frame.inner = eroded(frame.mask, 3);
    PhotonMap light =
        shot.photons; // without painted photons every pixel takes the light of its own seen point
    light.normals.clear();
    const SparseMap own = make_sparse_map(shot.world, frame.gbuffer, light, shot.settings);
    frame.photoreal = Image<Color>(view.width, view.height, Color(0));
    for (std::size_t i = 0; i < own.pixels.size(); ++i)
        if (frame.mask.pixels[i] != 0) frame.photoreal.pixels[i] = own.pixels[i].radiance;
    return frame;
}

PaintStyle louder(PaintStyle style, double factor) {
    style.noise_lightness *= factor;
    style.noise_chroma *= factor;
    for (PaintLayer& layer : style.layers) layer.noise_lightness *= factor, layer.noise_chroma *= factor;
    return style;
}

PaintStyle painted_style(const World& world) {
    for (const WorldObject& object : world.objects)
        if (object.npr) return object.paint;
    fmt::print(stderr, "the scene has no painted object\n");
    std::exit(3);
}

// ---- the three ways
// -------------------------------------------------------------------------------------------------

Image<Color> paint_ours(const Shot& shot, const Shown& frame) {
    const std::uint64_t seed = shot.settings.render.seed;
    SparseMap sparse = make_sparse_map(shot.world, frame.gbuffer, shot.photons, shot.settings);
    orient_strokes(sparse, shot.world, frame.gbuffer, shot.photons, shot.oriented);
    if (auto shown = without_hidden(sparse, shot.world, frame.gbuffer, shot.photons)) sparse = std::move(*shown);
    const InformativeMap informative = make_informative_map(sparse, shot.world, frame.gbuffer, seed);
    return convolve(informative, find_seats(shot.world, frame.gbuffer, shot.photons), shot.world,
                    frame.gbuffer, seed)
        .color;
}

Image<Color> paint_last(const Shot& shot, const Shown& frame, double factor) {
    return paint_picture(frame.photoreal, frame.mask, louder(painted_style(shot.world), factor),
                         shot.settings.render.seed);
}

// A picture of soft hills of brightness, filtered by ILIC of length 60, about 1 in the mean.
Image<Color> make_wrapping(const Shot& shot, double factor) {
    Image<Color> picture(640, 320);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const double u = 2 * pi * x / picture.width, v = 2 * pi * y / picture.height;
            picture.at(x, y) = Color(static_cast<float>(0.5 + 0.02 * std::sin(3 * u + 2 * std::sin(2 * v)) +
                                                        0.02 * std::sin(5 * v + 2 * std::cos(2 * u))));
        }
    PaintStyle style = louder(painted_style(shot.world), factor);
    style.length = 60;
    for (PaintLayer& layer : style.layers) layer.length = 60;
    style.contrast = style.saturation = 1;
    style.warm = 0;
    picture = paint_picture(picture, style, shot.settings.render.seed);
    for (Color& c : picture.pixels) c *= 2.0f;
    return picture;
}

// A turn of the picture goes once round the axis through the object's middle, and its height along it.
Image<Color> paint_first(const Shot& shot, const Shown& frame, const Image<Color>& wrapping) {
    Image<Color> result(frame.mask.width, frame.mask.height, Color(0));
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        if (frame.mask.pixels[i] == 0) continue;
        const Seen& seen = frame.gbuffer.seen.pixels[i];
        const Bounds& box = shot.world.objects[seen.object].bounds;
        const Vec3 middle = 0.5 * (box.low + box.high), p = Vec3(seen.position) - middle;
        const double height = (p.y + middle.y - box.low.y) / (box.high.y - box.low.y);
        const double fx = (std::atan2(p.z, p.x) / (2 * pi) + 0.5) * wrapping.width - 0.5;
        const double fy = std::clamp(1 - height, 0.0, 1.0) * (wrapping.height - 1);
        const int x = static_cast<int>(std::floor(fx)), y = static_cast<int>(std::floor(fy));
        Color sum(0);
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k) {
                const double w = (k ? fx - x : 1 - fx + x) * (j ? fy - y : 1 - fy + y);
                sum += static_cast<float>(w) * wrapping.at((x + k + wrapping.width) % wrapping.width,
                                                           std::min(y + j, wrapping.height - 1));
            }
        result.pixels[i] = frame.photoreal.pixels[i] * sum;
    }
    return result;
}

// ---- measuring
// -------------------------------------------------------------------------------------------------

Image<Color> shown(const Image<Color>& linear) {
    Image<Color> result = linear;
    for (Color& c : result.pixels) c = glm::clamp(display_from_linear(c), Color(0), Color(1));
    return result;
}

double contrast(const Image<Color>& linear, const Shown& frame) {
    const Image<Color> picture = shown(linear);
    Image<Color> calm = picture;
    masked_blur(calm, frame.mask, scaled(12, picture.height));
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (frame.inner.pixels[i] == 0) continue;
        const Color d = picture.pixels[i] - calm.pixels[i];
        sum += static_cast<double>(glm::dot(d, d)) / 3;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

struct Difference {
    double sum = 0, count = 0;
};

// Where a pixel's seen point lies in the next frame, if that shows it.
std::optional<Vec2> moved(const Shown& from, const Shown& to, int x, int y) {
    const Seen& seen = from.gbuffer.seen.at(x, y);
    const auto place = project(to.gbuffer.view, Vec3(seen.position));
    if (!place) return {};
    const int px = static_cast<int>(std::floor(place->pixel.x)),
              py = static_cast<int>(std::floor(place->pixel.y));
    if (!to.inner.contains(px, py) || to.inner.at(px, py) == 0) return {};
    const Seen& there = to.gbuffer.seen.at(px, py);
    if (there.object != seen.object) return {};
    const Vec3f guess = there.position + there.dpdx * static_cast<float>(place->pixel.x - px - 0.5) +
                        there.dpdy * static_cast<float>(place->pixel.y - py - 0.5);
    const float tolerance = 0.5f * (glm::length(there.dpdx) + glm::length(there.dpdy));
    if (glm::distance(guess, seen.position) > tolerance) return {};
    return place->pixel;
}

void compare(const Shown& from, const Shown& to, const Image<Color>& before, const Image<Color>& after,
             Difference& d) {
    const Image<Color> a = shown(before), b = shown(after);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (from.inner.at(x, y) == 0) continue;
            const auto place = moved(from, to, x, y);
            if (!place) continue;
            const double fx = place->x - 0.5, fy = place->y - 0.5;
            const int px = static_cast<int>(std::floor(fx)), py = static_cast<int>(std::floor(fy));
            Color there(0);
            for (int j = 0; j < 2; ++j)
                for (int i = 0; i < 2; ++i)
                    there += static_cast<float>((i ? fx - px : 1 - fx + px) * (j ? fy - py : 1 - fy + py)) *
                             b.at(px + i, py + j);
            const Color difference = there - a.at(x, y);
            d.sum += static_cast<double>(glm::dot(difference, difference)) / 3;
            ++d.count;
        }
}

// The factor of the noise at which a way of painting has the contrast asked for.
template <class Paint>
double match(double wanted, const Shown& frame, Paint&& paint) {
    double factor = 1;
    for (int round = 0; round < 3; ++round) {
        const double reached = contrast(paint(factor), frame);
        if (std::abs(reached / wanted - 1) < 0.02) break;
        factor = std::clamp(factor * wanted / reached, 0.01, 50.0);
    }
    return factor;
}

Words read_words(int count, char** values) {
    Words words;
    for (int i = 1; i < count; ++i) {
        const std::string word = values[i];
        const auto value = [&] { return i + 1 < count ? std::string(values[++i]) : std::string(); };
        if (word == "--frames")
            words.frames = std::atoi(value().c_str());
        else if (word == "--height")
            words.height = std::atoi(value().c_str());
        else if (word == "--turn")
            words.turn = std::atof(value().c_str());
        else if (word == "--pictures")
            words.pictures = value();
        else if (word == "--only-ours")
            words.only_ours = true;
        else if (word == "-L")
            words.library.emplace_back(value());
        else
            words.scene = word;
    }
    return words;
}

} // namespace

int main(int count, char** values) {
    const Words words = read_words(count, values);
    if (words.scene.empty() || words.frames < 2 || words.height < 16) {
        fmt::print(
            stderr,
            "bench_coherence SCENE [--frames N] [--height H] [--turn SHARE] [-L DIR] [--pictures DIR]\n");
        return 2;
    }
    const Shot shot = prepare(words);
    const Shown first = see(shot, words, 0);
    double last_factor = 1;
    Image<Color> wrapping;
    if (!words.only_ours) {
        const double wanted = contrast(paint_ours(shot, first), first);
        last_factor = match(wanted, first, [&](double f) { return paint_last(shot, first, f); });
        wrapping = make_wrapping(shot, match(wanted, first, [&](double f) {
                                     return paint_first(shot, first, make_wrapping(shot, f));
                                 }));
    }

    struct Way {
        std::string name;
        std::function<Image<Color>(const Shown&)> paint;
        Difference difference;
        double contrast = 0;
        Image<Color> before;
    };
    std::vector<Way> ways{{"ours", [&](const Shown& f) { return paint_ours(shot, f); }, {}, 0, {}},
                          {"rendered_first_ilic_last",
                           [&](const Shown& f) { return paint_last(shot, f, last_factor); },
                           {},
                           0,
                           {}},
                          {"ilic_first_texture_last",
                           [&](const Shown& f) { return paint_first(shot, f, wrapping); },
                           {},
                           0,
                           {}},
                          {"no_paint", [&](const Shown& f) { return f.photoreal; }, {}, 0, {}}};
    if (words.only_ours) ways.resize(1);
    Shown before;
    for (int i = 0; i < words.frames; ++i) {
        Shown frame = see(shot, words, words.turn * i / words.frames);
        for (Way& way : ways) {
            Image<Color> picture = way.paint(frame);
            way.contrast += contrast(picture, frame) / words.frames;
            if (i > 0) compare(before, frame, way.before, picture, way.difference);
            if (!words.pictures.empty())
                write_png(fmt::format("{}/{}_{:02}.png", words.pictures, way.name, i), picture, {}, {});
            way.before = std::move(picture);
        }
        before = std::move(frame);
    }
    fmt::print("way,rms,contrast,rms_over_contrast,pixels\n");
    for (const Way& way : ways)
        fmt::print("{},{:.4f},{:.4f},{:.3f},{:.0f}\n", way.name,
                   std::sqrt(way.difference.sum / way.difference.count), way.contrast,
                   std::sqrt(way.difference.sum / way.difference.count) / way.contrast, way.difference.count);
    return 0;
}
