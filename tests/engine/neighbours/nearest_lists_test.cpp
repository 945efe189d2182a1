// SPDX-License-Identifier: Apache-2.0
// Which neighbours are neighbours of each other, against a look into every list.
#include "engine/neighbours/nearest_lists.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace lacuna {
namespace {

using Lists = std::vector<std::vector<std::uint32_t>>;
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // to q, from p

// `count` different points each, near it in number, and now and then one that is not owned.
Lists drawn_lists(Random& random, std::uint32_t owned, std::size_t count) {
  Lists lists(owned);
  for (std::uint32_t p = 0; p < owned; ++p) {
    while (lists[p].size() < count) {
      const std::int64_t reach = 2 * std::int64_t(count);
      const std::int64_t q = std::int64_t(p) + random.whole(-reach, reach);
      if (q < 0 || q == p || q >= std::int64_t(owned) + 5) continue;
      if (std::count(lists[p].begin(), lists[p].end(), q) == 0) lists[p].push_back(std::uint32_t(q));
    }
  }
  return lists;
}

Edges expected_edges(const Lists& lists) {
  Edges edges;
  for (std::uint32_t p = 0; p < lists.size(); ++p) {
    for (const std::uint32_t q : lists[p])
      if (q < lists.size() && std::count(lists[q].begin(), lists[q].end(), p) == 0) edges.emplace_back(q, p);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Searched in runs of `run` points.
Edges found_edges(const Lists& lists, std::size_t count, std::uint32_t run) {
  const auto owned = std::uint32_t(lists.size());
  const std::size_t stride = (count + kListLine - 1) / kListLine;
  std::vector<ListLine> lines(stride * owned);
  for (std::uint32_t p = 0; p < owned; ++p) {
    std::fill_n(lines[p * stride].points, stride * kListLine, UINT32_MAX);
    std::copy(lists[p].begin(), lists[p].end(), lines[p * stride].points);
  }
  std::vector<std::uint16_t> mutual(lines.size());
  const NearestLists nearest{lines.data(), stride, count, mutual.data()};
  for (std::uint32_t first = 0; first < owned; first += run)
    find_mutual(nearest, first, std::min(first + run, owned));
  std::vector<std::uint32_t> q(owned * count + kListLine), p(q.size());
  Edges edges;
  for (std::uint32_t first = 0; first < owned; first += run) {
    const std::size_t found =
        find_one_sided(nearest, first, std::min(first + run, owned), owned, {q.data(), p.data()});
    for (std::size_t i = 0; i < found; ++i) edges.emplace_back(q[i], p[i]);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

TEST_CASE("edges to points whose lists do not hold their beginning are found, by every instruction set") {
  Random random(5);
  for (const std::size_t count : {1, 7, 15, 16, 17, 40}) {
    for (int round = 0; round < 10; ++round) {
      const Lists lists =
          drawn_lists(random, std::uint32_t(random.whole(std::int64_t(2 * count), 300)), count);
      const Edges expected = expected_edges(lists);
      by_each_instruction_set([&] {
        CHECK(found_edges(lists, count, 64) == expected);
        CHECK(found_edges(lists, count, 1) == expected);
      });
    }
  }
}

TEST_CASE("two points that are each other's only neighbours have no one-sided edge") {
  by_each_instruction_set([] { CHECK(found_edges({{1}, {0}}, 1, 2).empty()); });
}

}  // namespace lacuna
