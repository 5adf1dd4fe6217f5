// SPDX-License-Identifier: GPL-3.0-or-later
// The colours of patterns that stand without a map, read from POV-Ray's pictures.
#include "parser/blocks.h"

namespace pnr {

namespace {

ColorStop stop(double position, float r, float g, float b) { return {position, {Color(r, g, b), 0, 0}}; }

// One colour up to each position.
struct Band {
    double end;
    Color color;
};

std::vector<ColorStop> bands(std::initializer_list<Band> list) {
    std::vector<ColorStop> stops;
    double start = 0;
    for (const Band& band : list) {
        stops.push_back({start, {band.color, 0, 0}});
        stops.push_back({band.end, {band.color, 0, 0}});
        start = band.end;
    }
    return stops;
}

} // namespace

std::vector<ColorStop> default_map(const Token& word) {
    switch (keyword_of(word)) {
    case "agate"_kw:
        return {stop(0, 1, 1, 1),          stop(0.5, 0.95f, 0.75f, 0.5f), stop(0.5, 0.9f, 0.7f, 0.5f),
                stop(0.6, 0.9f, 0.7f, 0.4f), stop(0.6, 1, 0.7f, 0.4f),    stop(1, 0.6f, 0.3f, 0)};
    case "bozo"_kw:
        return bands({{0.4, Color(1)}, {0.6, {0, 1, 0}}, {0.8, {0, 0, 1}}, {1, {1, 0, 0}}});
    case "mandel"_kw:
        return {stop(0, 0, 0, 0),     stop(0.001, 0, 0, 0), stop(0.001, 0, 1, 1),
                stop(0.012, 1, 1, 0), stop(0.015, 1, 0, 1), stop(0.1, 0, 1, 1)};
    case "marble"_kw:
        return {stop(0, 0.9f, 0.8f, 0.8f), stop(0.9, 0.9f, 0.08f, 0.08f), stop(0.9, 0, 0, 0)};
    case "radial"_kw:
        return {stop(0, 0, 1, 1), stop(0.333, 1, 1, 0), stop(0.666, 1, 0, 1), stop(1, 0, 1, 1)};
    case "wood"_kw:
        return bands({{0.6, {0.666f, 0.312f, 0.2f}}, {1, {0.4f, 0.1333f, 0.066f}}});
    default:
        return {stop(0, 0, 0, 0), stop(1, 1, 1, 1)};
    }
}

} // namespace pnr
