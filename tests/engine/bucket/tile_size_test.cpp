// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/split.hpp"

#include "engine/config/job.hpp"
#include "engine/run/error.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

std::uint64_t tile_points(std::uint64_t points, std::uint64_t memory_limit, std::int64_t threads,
                          std::int64_t k = 15, std::int64_t wanted = 0) {
  Config config;
  config.run = {.threads = threads, .memory_limit = memory_limit, .tile_points = wanted};
  config.neighbourhood.k = k;
  return points_per_tile(points, config, workers_of(config.run));
}

TEST_CASE("however many threads work, the tables with entries for each tile fit in memory") {
  for (const std::int64_t threads : {1, 2, 16, 64}) {
    INFO(threads << " threads");
    CHECK(10'000'000 / tile_points(10'000'000, 64 * kMiB, threads) < 4096);
    CHECK(10'000'000 / tile_points(10'000'000, 64 * kMiB, threads, 15, 100) < 4096);
  }
}

TEST_CASE(
    "more points than the memory limit can ever hold are refused, and the limit that is named is enough") {
  const std::uint64_t points = 1'000'000'000;
  CHECK_THROWS_WITH(tile_points(points, 64 * kMiB, 2),
                    "the memory limit of 64 MiB is too small for 1000000000 points; allowed: 143MiB or more");
  CHECK_THROWS_AS(tile_points(points, 142 * kMiB, 2), Error);
  CHECK(tile_points(points, 143 * kMiB, 2) > 0);
}

TEST_CASE("the neighbours in a tile can be numbered in 32 bits, whatever is asked for") {
  for (const std::int64_t k : {15, 128, 1000}) {
    INFO("k = " << k);
    const std::uint64_t most = tile_points(1'000'000'000, 64 * 1024 * kMiB, 2, k, 1'000'000'000);
    CHECK(2 * static_cast<std::uint64_t>(k) * most <= std::uint64_t{1} << 32);
  }
}

}  // namespace
}  // namespace lacuna
