// SPDX-License-Identifier: Apache-2.0
#include "engine/model/task_share.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

TEST_CASE("tasks share things in runs of about equal weights, each thing once") {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint64_t> weights;
    for (std::int64_t left = random.whole(1, 40); left > 0; --left)
      weights.push_back(static_cast<std::uint64_t>(random.whole(1, 100)));
    const auto tasks = static_cast<std::size_t>(random.whole(1, 12));
    const std::uint64_t all = std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
    const std::uint64_t heaviest = *std::max_element(weights.begin(), weights.end());
    std::size_t next = 0;
    for (std::size_t task = 0; task < tasks; ++task) {
      const IndexRange range = share_of(weights, {task, tasks});
      CHECK(range.first == next);
      REQUIRE(range.last >= range.first);
      next = range.last;
      std::uint64_t mine = 0;
      for (std::size_t i = range.first; i < range.last; ++i) mine += weights[i];
      CHECK(mine <= all / tasks + heaviest + 1);
    }
    CHECK(next == weights.size());
  }
}

}  // namespace
}  // namespace lacuna
