// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace pnr {

namespace {

// One part of float channels; `values` appends a pixel's numbers in the channels' order.
using PixelValues = std::function<void(std::size_t pixel, std::vector<float>& out)>;

ImagePart make_part(std::vector<std::string> channels, std::size_t pixels, const PixelValues& values) {
    ImagePart part{"", std::move(channels), {}, false};
    part.data.reserve(pixels * part.channel_names.size());
    for (std::size_t i = 0; i < pixels; ++i) values(i, part.data);
    return part;
}

std::size_t pixel_count(const Rendering& r) {
    return static_cast<std::size_t>(r.settings.render.width) *
           static_cast<std::size_t>(r.settings.render.height);
}

void append(std::vector<float>& out, Vec3f v) { out.insert(out.end(), {v.x, v.y, v.z}); }
void append(std::vector<float>& out, Vec2f v) { out.insert(out.end(), {v.x, v.y}); }

ImagePart color_part(const Rendering& r, const Image<Color>& image) {
    return make_part({"R", "G", "B"}, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        append(out, image.empty() ? Color(0) : image.pixels[i]);
    });
}

ImagePart density_part(const Rendering& r) {
    const Image<float>& density = r.rendered.parts.photon_density;
    return make_part({"photon.density"}, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        out.push_back(density.empty() ? 0.0f : density.pixels[i]);
    });
}

ImagePart error_part(const Rendering& r, const std::string& name, const Image<float>& error) {
    return make_part({name}, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        out.push_back(error.empty() ? 0.0f : error.pixels[i]);
    });
}

// Samples of each pixel that no picture can show.
ImagePart numbers_part(const Rendering& r) {
    Image<Vec3f> counts(r.settings.render.width, r.settings.render.height, Vec3f(0));
    for (const FaultPlace& place : r.fault_places)
        counts.at(place.x, place.y) = Vec3f(place.faults.nan, place.faults.inf, place.faults.negative);
    return make_part({"numbers.nan", "numbers.inf", "numbers.negative"}, pixel_count(r),
                     [&](std::size_t i, std::vector<float>& out) { append(out, counts.pixels[i]); });
}

ImagePart mask_part(const Rendering& r) {
    return make_part({"npr.mask"}, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        out.push_back(r.gbuffer.coverage.pixels[i]);
    });
}

struct Aov {
    std::string name;
    std::function<ImagePart(const Rendering&)> part;
};
const std::vector<Aov>& aovs() {
    using R = const Rendering&;
    static const std::vector<Aov> all{
        {"N",
         [](R r) {
             return select_channels(gbuffer_part(r), {"N.X", "N.Y", "N.Z"});
         }},
        {"P",
         [](R r) {
             return select_channels(gbuffer_part(r), {"P.X", "P.Y", "P.Z"});
         }},
        {"Z", [](R r) { return select_channels(gbuffer_part(r), {"Z"}); }},
        {"id",
         [](R r) {
             return select_channels(gbuffer_part(r), {"id.object", "id.via"});
         }},
        {"npr.mask", mask_part},
        {"direct", [](R r) { return color_part(r, r.rendered.parts.direct); }},
        {"indirect", [](R r) { return color_part(r, r.rendered.parts.indirect); }},
        {"caustic", [](R r) { return color_part(r, r.rendered.parts.caustic); }},
        {"specular", [](R r) { return color_part(r, r.rendered.parts.specular); }},
        {"photon.density", density_part},
        {"error.noise", [](R r) { return error_part(r, "error.noise", r.error.noise); }},
        {"error.bias", [](R r) { return error_part(r, "error.bias", r.error.bias); }},
        {"numbers", numbers_part},
        {"sparse", sparse_part},
        {"informative", informative_part},
        {"partial", [](R r) { return layer_part(r.paint.layer); }},
    };
    return all;
}

} // namespace

ImagePart gbuffer_part(const Rendering& r) {
    const std::vector<std::string> channels{"N.X", "N.Y", "N.Z",       "P.X",    "P.Y",
                                            "P.Z", "Z",   "id.object", "id.via", "npr"};
    return make_part(channels, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        const Seen& seen = r.gbuffer.seen.pixels[i];
        if (seen.z == 0) {
            out.insert(out.end(), channels.size(), 0.0f);
            return;
        }
        append(out, seen.normal);
        append(out, Vec3f(Vec3(seen.position) + r.world.offset));
        out.insert(out.end(), {seen.z, static_cast<float>(seen.object), static_cast<float>(seen.via),
                               seen.npr ? 1.0f : 0.0f});
    });
}

ImagePart sparse_part(const Rendering& r) {
    const std::vector<std::string> channels{"R", "G",         "B",      "dir.X", "dir.Y",
                                            "Z", "id.object", "id.via", "source"};
    return make_part(channels, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        if (r.paint.sparse.empty() || r.paint.sparse.pixels[i].photon < 0) {
            out.insert(out.end(), channels.size(), 0.0f);
            return;
        }
        const SourcePixel& source = r.paint.sparse.pixels[i];
        append(out, source.radiance);
        append(out, source.direction);
        out.insert(out.end(),
                   {source.z, static_cast<float>(source.object), static_cast<float>(source.via), 1.0f});
    });
}

ImagePart informative_part(const Rendering& r) {
    const std::vector<std::string> channels{"R",         "G",      "B",        "dir.X", "dir.Y",
                                            "id.object", "id.via", "coverage", "kind"};
    return make_part(channels, pixel_count(r), [&](std::size_t i, std::vector<float>& out) {
        const float coverage = r.gbuffer.coverage.empty() ? 0.0f : r.gbuffer.coverage.pixels[i];
        if (r.paint.informative.empty() || r.paint.informative.pixels[i].kind == PixelKind::outside) {
            out.insert(out.end(), {0, 0, 0, 0, 0, 0, 0, coverage, 0});
            return;
        }
        const Informed& p = r.paint.informative.pixels[i];
        append(out, p.radiance);
        append(out, axis_direction(p.axis));
        out.insert(out.end(), {static_cast<float>(p.object), static_cast<float>(p.via), coverage,
                               static_cast<float>(p.kind)});
    });
}

ImagePart layer_part(const Layer& layer) {
    return make_part({"R", "G", "B", "A"}, layer.color.pixels.size(),
                     [&](std::size_t i, std::vector<float>& out) {
                         append(out, layer.color.pixels[i]);
                         out.push_back(layer.alpha.pixels[i]);
                     });
}

const std::vector<std::string>& aov_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Aov& aov : aovs()) all.push_back(aov.name);
        return all;
    }();
    return names;
}

ImagePart aov_part(const Rendering& r, const std::string& name) {
    for (const Aov& aov : aovs()) {
        if (aov.name != name) continue;
        ImagePart part = aov.part(r);
        part.name = name;
        return part;
    }
    throw std::invalid_argument("aov_part: no part " + name);
}

ImagePart select_channels(const ImagePart& part, const std::vector<std::string>& channels) {
    std::vector<std::size_t> indices;
    for (const std::string& name : channels) {
        const auto found = std::find(part.channel_names.begin(), part.channel_names.end(), name);
        if (found == part.channel_names.end())
            throw std::invalid_argument("select_channels: no channel " + name);
        indices.push_back(static_cast<std::size_t>(found - part.channel_names.begin()));
    }
    const std::size_t stride = part.channel_names.size();
    ImagePart chosen{part.name, channels, {}, part.half};
    for (std::size_t pixel = 0; pixel < part.data.size() / stride; ++pixel)
        for (const std::size_t index : indices) chosen.data.push_back(part.data[pixel * stride + index]);
    return chosen;
}

ImagePart cut(const ImagePart& part, int width, const PixelRect& window) {
    const std::size_t stride = part.channel_names.size();
    ImagePart small{part.name, part.channel_names, {}, part.half};
    for (int y = window.y0; y < window.y1; ++y) {
        const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        const auto begin = (row + static_cast<std::size_t>(window.x0)) * stride;
        const auto end = (row + static_cast<std::size_t>(window.x1)) * stride;
        small.data.insert(small.data.end(), part.data.begin() + static_cast<std::ptrdiff_t>(begin),
                          part.data.begin() + static_cast<std::ptrdiff_t>(end));
    }
    return small;
}

Metadata radius_metadata(const Rendering& r) {
    Metadata metadata;
    float largest = 0;
    for (std::size_t id = 1; id < r.world.objects.size(); ++id) {
        if (!r.world.objects[id].npr) continue;
        const auto radius =
            static_cast<float>(scaled(r.world.objects[id].paint.radius, r.settings.render.height));
        largest = std::max(largest, radius);
        metadata.emplace_back(fmt::format("pnr:radius.{}", id), radius);
    }
    metadata.emplace_back("pnr:radius", largest);
    return metadata;
}

bool wants_light_parts(const std::vector<std::string>& aovs) {
    return std::any_of(aovs.begin(), aovs.end(), [](const std::string& name) {
        return name == "direct" || name == "indirect" || name == "caustic" || name == "specular" ||
               name == "photon.density";
    });
}

void check_aovs(const std::vector<std::string>& asked) {
    const std::vector<std::string>& known = aov_names();
    for (const std::string& name : asked) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        const std::string_view near = nearest_word(name, {known.begin(), known.end()});
        throw UsageError(fmt::format("--aov: there is no part `{}`{}", name,
                                     near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
    }
}

} // namespace pnr
