// SPDX-License-Identifier: GPL-3.0-or-later
// Points in space that come one after the other, asked each time which lie near.
#pragma once

#include "core/types.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace pnr {

// Buckets twice as wide as the distance that is asked for, so that eight of them hold all that lies within
// it. They share the slots of a table; the distance tells their points apart.
class PointBuckets {
public:
    // `distance` > 0: the largest that will be asked for; `expected`: about how many points will come.
    PointBuckets(float distance, std::size_t expected)
        : distance_(distance), first_(std::bit_ceil(expected + 1), -1) {}

    void add(Vec3f p) {
        std::int32_t& slot = first_[slot_of(glm::ivec3(glm::floor(p / (2 * distance_))))];
        entries_.push_back({p, slot});
        slot = static_cast<std::int32_t>(entries_.size()) - 1;
    }
    // The distance of the nearest point, if it is less than `within`, else infinity.
    float nearest(Vec3f p, float within) const {
        const glm::ivec3 low = glm::ivec3(glm::floor(p / (2 * distance_) - 0.5f));
        float best2 = within * within;
        bool found = false;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 bucket = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
            for (std::int32_t i = first_[slot_of(bucket)]; i >= 0;
                 i = entries_[static_cast<std::size_t>(i)].next) {
                const Vec3f d = entries_[static_cast<std::size_t>(i)].point - p;
                const float distance2 = glm::dot(d, d);
                if (distance2 >= best2) continue;
                best2 = distance2;
                found = true;
            }
        }
        return found ? std::sqrt(best2) : std::numeric_limits<float>::infinity();
    }

private:
    struct Entry {
        Vec3f point;
        std::int32_t next;
    };
    std::size_t slot_of(glm::ivec3 b) const {
        const auto word =
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(b.x)) * 0x9e3779b97f4a7c15ull ^
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(b.y)) * 0xd1342543de82ef95ull ^
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(b.z)) * 0xbf58476d1ce4e5b9ull;
        return static_cast<std::size_t>(word >> 32) & (first_.size() - 1);
    }

    float distance_;
    std::vector<std::int32_t> first_;
    std::vector<Entry> entries_;
};

} // namespace pnr
