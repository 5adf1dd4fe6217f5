// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/parallel.h"

#include <atomic>
#include <stdexcept>

namespace pnr {
namespace {

TEST(Parallel, ChunksCoverTheRangeOnceWhateverTheThreads) {
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(thread_count(), threads);
        std::vector<int> seen(1003, 0), chunk_of(1003, -1);
        parallel_for(1003, 10, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
            for (std::int64_t i = begin; i < end; ++i) {
                ++seen[static_cast<std::size_t>(i)];
                chunk_of[static_cast<std::size_t>(i)] = static_cast<int>(chunk);
            }
        });
        for (std::size_t i = 0; i < seen.size(); ++i) {
            ASSERT_EQ(seen[i], 1);
            ASSERT_EQ(chunk_of[i], static_cast<int>(i / 10));
        }
    }
}

TEST(Parallel, PassesAnExceptionOnAndTakesNoWork) {
    EXPECT_THROW(parallel_for(100, 1,
                              [](std::int64_t begin, std::int64_t, std::int64_t) {
                                  if (begin == 57) throw std::runtime_error("chunk 57");
                              }),
                 std::runtime_error);
    std::atomic<int> calls{0};
    parallel_for(0, 8, [&](std::int64_t, std::int64_t, std::int64_t) { ++calls; });
    EXPECT_EQ(calls, 0);
}

} // namespace
} // namespace pnr
