// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures in patterns: from files, and made by functions.
#include "parser/blocks.h"
#include "parser/expression.h"
#include "parser/function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace pnr {

namespace {

// What a function image keeps of a value: 16 bits, cut off, as POV-Ray (which wraps beyond 1).
float kept_value(double value) {
    if (!std::isfinite(value)) return 0;
    const auto whole = static_cast<std::int64_t>(std::clamp(value * 65535, -1e15, 1e15));
    return static_cast<float>(static_cast<std::uint16_t>(whole)) / 65535;
}

// `function W, H { ... }`: x from 0 to 1 to the right, y from 0 to 1 downwards, ends included.
Image<glm::vec4> parse_function_image(Parser& p) {
    const Token word = next(p);
    const int width = parse_int(p, 1, 1 << 14, "the width of the picture");
    accept_comma(p);
    const int height = parse_int(p, 1, 1 << 14, "the height of the picture");
    charge(p, word, sizeof(glm::vec4) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto function = parse_function_body(p, word);
    Image<glm::vec4> image(width, height, glm::vec4(0, 0, 0, 1));
    if (!function->unsupported.empty()) {
        warn_unsupported(p, word, function->unsupported, "the picture is black");
        return image;
    }
    if (function->parameters > 3) fail(p, word, "the function of a picture has at most three parameters");
    charge_calls(p, word, *function, double(width) * height);
    const auto parameters = static_cast<std::size_t>(function->parameters);
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const std::array<double, 3> at{width > 1 ? double(i) / (width - 1) : 0,
                                           height > 1 ? double(j) / (height - 1) : 0, 0};
            std::array<double, 5> values{};
            if (function->native)
                function->native(at.data(), values.data());
            else
                values[0] = evaluate(*function, std::span(at).first(parameters));
            const bool color = function->results == 5;
            glm::vec4& pixel = image.at(i, j);
            for (int c = 0; c < 3; ++c)
                pixel[c] = kept_value(values[color ? static_cast<std::size_t>(c) : 0]);
            if (color) pixel.w = 1 - kept_value(values[4]);
        }
    return image;
}

ImageMapType parse_map_type(Parser& p, const Token& word) {
    const int type = parse_int(p, 0, 7, "`map_type`");
    if (type != 0 && type != 1 && type != 2 && type != 5)
        fail(p, word, "`map_type` is 0 (planar), 1 (spherical), 2 (cylindrical) or 5 (torus)");
    return static_cast<ImageMapType>(type);
}

Interpolation parse_interpolation(Parser& p) {
    const int type = parse_int(p, 0, 4, "`interpolate`");
    return type == 1 ? Interpolation::bilinear : static_cast<Interpolation>(type);
}

// `filter all F`, or `filter N, F` for one colour of a palette, which we do not see.
void parse_image_transparency(Parser& p, const Token& word, float& value) {
    if (accept(p, "all"_kw)) {
        value = static_cast<float>(parse_float(p));
        return;
    }
    warn_unsupported(p, word, "transparency of single palette colours", "it is left out");
    parse_float(p), accept_comma(p), parse_float(p);
}

void parse_file_gamma(Parser& p, ImagePattern& image) {
    image.as_stored = false;
    if (accept(p, "srgb"_kw))
        image.file_gamma = 0;
    else
        image.file_gamma = parse_float_in(p, 1e-3, 1e3, "`gamma`");
}

bool skip_image_word(Parser& p) {
    switch (keyword_of(peek(p))) {
    case "png"_kw:
    case "jpeg"_kw:
    case "gif"_kw:
    case "tga"_kw:
    case "tiff"_kw:
    case "ppm"_kw:
    case "pgm"_kw:
    case "exr"_kw:
    case "hdr"_kw:
    case "iff"_kw:
    case "sys"_kw:
    case "pot"_kw:
        next(p); // the file itself says what it is
        return true;
    case "use_index"_kw:
    case "premultiplied"_kw:
        next(p), parse_optional_bool(p);
        return true;
    default:
        return false;
    }
}

void parse_image_item(Parser& p, ImagePattern& image) {
    const Token word = peek(p);
    if (at_string(p)) {
        image.said_at = source_ref(p, word);
        image.file = resolve_file(p, word, parse_string(p));
        return;
    }
    if (skip_image_word(p)) return;
    switch (keyword_of(word)) {
    case "function"_kw:
        image.image = std::make_shared<const Image<glm::vec4>>(parse_function_image(p));
        return;
    case "map_type"_kw:
        next(p), image.map_type = parse_map_type(p, word);
        return;
    case "once"_kw:
        next(p), image.once = true;
        return;
    case "interpolate"_kw:
        next(p), image.interpolation = parse_interpolation(p);
        return;
    case "use_color"_kw:
        next(p), image.use_color = parse_optional_bool(p);
        return;
    case "use_alpha"_kw:
        next(p), image.use_color = !parse_optional_bool(p);
        return;
    case "gamma"_kw:
        next(p), parse_file_gamma(p, image);
        return;
    case "filter"_kw:
        parse_image_transparency(p, next(p), image.filter);
        return;
    case "transmit"_kw:
        parse_image_transparency(p, next(p), image.transmit);
        return;
    default:
        unexpected(
            p, "image_map",
            {"png"_kw, "jpeg"_kw, "map_type"_kw, "once"_kw, "interpolate"_kw, "function"_kw, "gamma"_kw});
    }
}

} // namespace

ImagePattern parse_image_map(Parser& p, double* bump_size) {
    ImagePattern image;
    image.interpolation = Interpolation::none; // POV-Ray's default is the nearest pixel
    image.as_stored = p.scene.povray && (!p.in.version_said || p.in.version < 3.7); // as POV-Ray 3.7 does
    const Token opener = peek(p);
    block(p, "image_map", [&] {
        if (bump_size && accept(p, "bump_size"_kw))
            *bump_size = parse_float(p);
        else
            parse_image_item(p, image);
        accept_comma(p);
    });
    if (image.file.empty() && !image.image)
        fail(p, opener, "`image_map` needs a picture, such as \"wood.png\"");
    return image;
}

} // namespace pnr
