// SPDX-License-Identifier: Apache-2.0
// Lists that come in runs.
#include "engine/store/merge_runs.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {

TEST_CASE("runs are merged as a stable sort would") {
  Random random(2);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<int, int>> records;  // key, place
    for (std::int64_t runs = random.whole(0, 4); runs > 0; --runs) {
      const auto begin = records.size();
      for (std::int64_t i = random.whole(0, 30); i > 0; --i) records.emplace_back(random.whole(0, 20), 0);
      std::sort(records.begin() + std::ptrdiff_t(begin), records.end());
    }
    for (std::size_t i = 0; i < records.size(); ++i) records[i].second = int(i);
    const auto by_key = [](const auto& a, const auto& b) { return a.first < b.first; };
    auto expected = records;
    std::stable_sort(expected.begin(), expected.end(), by_key);
    merge_runs(records, by_key);
    wrong += records != expected;
  }
  CHECK(wrong == 0);
}

}  // namespace lacuna
