// SPDX-License-Identifier: GPL-3.0-or-later
#include "npr/noise_cells.h"

#include "core/rng.h"

namespace pnr {

namespace {

CellRecord make_record(const RegionWork& work, const PaintLayer& coat, Color base, std::uint64_t hash,
                       float priority) {
    CellRecord record;
    record.base = base;
    record.deviates = work.style.paper_mode ? cell_uniform_deviates(hash) : cell_deviates(hash);
    record.height = unit_float(hash_words(hash, 20));
    record.priority = priority;
    record.weight = std::exp(std::max(-690.0, coat.edge * (static_cast<double>(priority) - 1)));
    return record;
}

} // namespace

std::vector<CellRecord> make_pixel_cells(RegionWork& work, const PaintLayer& coat, const Image<Color>& base,
                                         double cell, int coat_number) {
    const auto side = static_cast<int>(std::max(1L, std::lround(cell)));
    std::vector<CellRecord> records(base.pixels.size());
    const std::uint64_t key = hash_words(hash_words(work.seed, static_cast<std::uint64_t>(Pass::noise)),
                                         static_cast<std::uint64_t>(coat_number));
    for (int y = 0; y < base.height; ++y) {
        for (int x = 0; x < base.width; ++x) {
            const std::uint64_t place = static_cast<std::uint64_t>((work.region.box.y0 + y) / side) << 32 |
                                        static_cast<std::uint64_t>((work.region.box.x0 + x) / side);
            const std::uint64_t hash = hash_words(key, place);
            records[static_cast<std::size_t>(y) * static_cast<std::size_t>(base.width) +
                    static_cast<std::size_t>(x)] =
                make_record(work, coat, base.at(x, y), hash, unit_float(hash_words(hash, 1)));
        }
    }
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        work.canvas.at(x + work.canvas.rim, y + work.canvas.rim).cell =
            static_cast<std::uint32_t>((y / work.scale) * base.width + x / work.scale);
    });
    return records;
}

SiteGrid make_sites(const RegionWork& work, double cell, int coat_number) {
    const CellPlan plan{work.gbuffer, work.seats, work.region, work.mask,
                        work.brush,   cell,       work.seed,   coat_number};
    return build_site_grid(make_cell_sites(plan), work.region.box, cell);
}

std::vector<CellRecord> make_site_cells(RegionWork& work, const PaintLayer& coat, const Image<Color>& base,
                                        const SiteGrid& grid) {
    std::vector<CellRecord> records;
    records.reserve(grid.sites.size());
    for (const CellSite& site : grid.sites) {
        const int x = std::clamp(static_cast<int>(site.at.x) - work.region.box.x0, 0, base.width - 1);
        const int y = std::clamp(static_cast<int>(site.at.y) - work.region.box.y0, 0, base.height - 1);
        records.push_back(make_record(work, coat, base.at(x, y), site.hash, site.priority));
    }
    const float inverse = 1.0f / static_cast<float>(work.scale);
    for_each_canvas_row(work, [&](int x, int y, std::int64_t) {
        const int px = work.region.box.x0 + x / work.scale, py = work.region.box.y0 + y / work.scale;
        const Seen& seen = work.gbuffer.seen.at(px, py);
        const Vec2f at =
            Vec2f(work.region.box.x0, work.region.box.y0) + Vec2f(Vec2(x + 0.5, y + 0.5)) * inverse;
        const Vec2f off = at - Vec2f(Vec2(px + 0.5, py + 0.5));
        work.canvas.at(x + work.canvas.rim, y + work.canvas.rim).cell =
            nearest_site(grid, at, seen.position + off.x * seen.dpdx + off.y * seen.dpdy,
                         work.brush.spans.at(x / work.scale, y / work.scale));
    });
    return records;
}

} // namespace pnr
