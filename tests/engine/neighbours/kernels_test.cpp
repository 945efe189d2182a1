// SPDX-License-Identifier: Apache-2.0
// Kernels by each instruction set. No candidate of a query is missed, and an order that rounding may decide
// is ambiguous. Neighbours of each other are found.
#include "engine/neighbours/candidate_list.hpp"
#include "engine/neighbours/nearest_lists.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace lacuna {
namespace {

// ---- Candidates

// A list of candidates at these squared distances; their points are 100, 101, ...
CandidateList list_of(const std::vector<float>& squared_distances, float limit, float margin) {
  CandidateList list{};
  for (const float squared : squared_distances) {
    list.squared_distances[list.count] = squared;
    list.points[list.count] = 100 + static_cast<std::uint32_t>(list.count);
    ++list.count;
  }
  list.limit = limit;
  list.margin = margin;
  return list;
}

std::vector<std::pair<std::uint32_t, float>> listed(const CandidateList& list) {
  std::vector<std::pair<std::uint32_t, float>> found;
  for (std::size_t i = 0; i < list.count; ++i) found.emplace_back(list.points[i], list.squared_distances[i]);
  return found;
}

TEST_CASE("all points within a limit are listed, by every instruction set") {
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    const auto blocks = static_cast<std::size_t>(random.whole(1, kMostBlocks));
    std::vector<Block> all(blocks + 3);
    std::vector<double> low[3], high[3];
    for (Block& block : all) {
      for (int axis = 0; axis < 3; ++axis) {
        const double from = 1e6 + random.uniform(0, 5);
        for (double& coordinate : block.coordinates[axis]) coordinate = from + random.uniform(0, 1);
        const auto [least, most] =
            std::minmax_element(block.coordinates[axis], block.coordinates[axis] + kBlock);
        low[axis].push_back(*least);
        high[axis].push_back(*most);
      }
    }
    const double* const lows[3] = {low[0].data(), low[1].data(), low[2].data()};
    const double* const highs[3] = {high[0].data(), high[1].data(), high[2].data()};
    Surroundings surroundings{.origin = {1e6 + 2, 1e6 + 3, 1e6 + 2.5}, .scale = 0.5, .margin = 1e-5};
    for (std::size_t i = 0; i < blocks; ++i)
      surroundings.blocks[surroundings.count++] = static_cast<std::uint32_t>(i + 3);
    const float query[3] = {0.125F, -0.25F, 0.0625F};
    const auto limit = static_cast<float>(random.uniform(0.01, 0.3));

    std::vector<std::pair<std::uint32_t, float>> expected;
    for (std::size_t b = 3; b < all.size(); ++b) {
      for (std::size_t i = 0; i < kBlock; ++i) {
        float difference[3];
        for (int axis = 0; axis < 3; ++axis)
          difference[axis] = static_cast<float>((all[b].coordinates[axis][i] - surroundings.origin[axis]) *
                                                surroundings.scale) -
                             query[axis];
        const float squared =
            (difference[0] * difference[0] + difference[1] * difference[1]) + difference[2] * difference[2];
        if (squared <= limit) expected.emplace_back(b * kBlock + i, squared);
      }
    }
    INFO("round " << round << ", " << expected.size() << " points");
    by_each_instruction_set([&] {
      fill_surroundings(all.data(), lows, highs, surroundings);
      CandidateList list{};
      find_within(surroundings, query, limit, list);
      if (expected.size() > kMostCandidates) {
        CHECK(list.count == kMostCandidates + 1);
        return;
      }
      CHECK(listed(list) == expected);
      CHECK(list.limit == limit);
      CHECK(list.margin == 1e-5F);
    });
  }
}

TEST_CASE("a narrowed list holds what is within the smaller limit, or all it held if that is too little") {
  Random random(6);
  std::size_t narrowed = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<float> all(static_cast<std::size_t>(random.whole(0, kMostCandidates)));
    for (float& squared : all) squared = static_cast<float>(random.whole(0, 100)) / 100;
    const float limit = 0.4F;
    std::vector<std::pair<std::uint32_t, float>> within;
    const CandidateList before = list_of(all, 1, 0);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i] <= limit) within.emplace_back(before.points[i], all[i]);
    for (const std::size_t least : {within.size(), within.size() + 1}) {
      by_each_instruction_set([&] {
        CandidateList list = before;
        narrow_list(limit, least, list);
        const bool is_narrow = least <= within.size();
        CHECK(list.limit == (is_narrow ? limit : 1));
        CHECK(list.count == (is_narrow ? within.size() : all.size()));
        if (is_narrow) CHECK(listed(list) == within);
        narrowed += is_narrow && within.size() < all.size();
      });
    }
  }
  CHECK(narrowed > 200);
}

TEST_CASE("candidates are ranked, and what is ambiguous is marked, by every instruction set") {
  const float margin = 1e-5F;
  const std::vector<CandidateList> lists = {
      list_of({0.5F, 0, 0.25F, 0.75F}, 1, margin),
      list_of({0.5F, 0, 0.5F + 1e-5F, 0.75F}, 1, margin),   // two nearly as near as each other
      list_of({0.5F, 0, 0.75F, 0.25F, 0.75F}, 1, margin),   // likewise, but not wanted
      list_of({0.5F, 0, 0.25F}, 0.5F + 1e-5F, margin),      // the last nearly at the limit
      list_of({0.5F, 0, 0.25F}, 0.5F + 1e-3F, margin),      // not so
      list_of({0.5F, 0, 0.5F + 1e-3F, 0.75F}, 1, 0.6e-3F),  // a larger margin
      list_of({}, 1, margin),
  };
  by_each_instruction_set([&] {
    Ranking ranking{};
    rank_candidates(lists.data(), lists.size(), 4, true, ranking);
    std::vector<bool> ambiguous(ranking.is_ambiguous, ranking.is_ambiguous + lists.size());
    CHECK(ambiguous == std::vector<bool>{false, true, false, true, false, true, false});
    rank_candidates(lists.data(), lists.size(), 3, true, ranking);
    ambiguous.assign(ranking.is_ambiguous, ranking.is_ambiguous + lists.size());
    CHECK(ambiguous == std::vector<bool>{false, true, false, false, false, true, false});
    std::uint32_t points[2];
    ranking.pick(lists[0], 0, 2, points);
    CHECK(points[0] == 102);
    CHECK(points[1] == 100);
    ranking.pick(lists[4], 4, 2, points);
    CHECK(points[0] == 102);
    CHECK(points[1] == 100);
    rank_candidates(lists.data(), lists.size(), 5, true, ranking);
    CHECK(ranking.is_ambiguous[2]);
    // What is in no list takes no part.
    rank_candidates(lists.data(), lists.size(), 4, false, ranking);
    CHECK_FALSE(ranking.is_ambiguous[3]);
  });
}

TEST_CASE("long lists are ranked, too, and lists that are too long count as empty") {
  Random random(7);
  std::vector<CandidateList> lists;
  for (std::size_t i = 0; i < kQueries; ++i) {
    std::vector<float> squared{0};
    const auto count = static_cast<std::size_t>(random.whole(40, kMostCandidates));
    while (squared.size() < count) squared.push_back(static_cast<float>(random.uniform(0.01, 1)));
    lists.push_back(list_of(squared, 1, 1e-9F));
  }
  lists[5].count = kMostCandidates + 1;
  constexpr std::size_t kWanted = 30;
  by_each_instruction_set([&] {
    Ranking ranking{};
    rank_candidates(lists.data(), lists.size(), kWanted, true, ranking);
    for (std::size_t i = 0; i < kQueries; ++i) {
      if (i == 5 || ranking.is_ambiguous[i]) continue;
      const CandidateList& list = lists[i];
      std::vector<std::uint32_t> expected(list.points, list.points + list.count), found(kWanted - 1);
      std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
        return list.squared_distances[a - 100] < list.squared_distances[b - 100];
      });
      ranking.pick(list, i, found.size(), found.data());
      CHECK(std::equal(found.begin(), found.end(), expected.begin() + 1));
    }
    CHECK(std::count(ranking.is_ambiguous, ranking.is_ambiguous + kQueries, true) < 4);
  });
}

// ---- Neighbours of each other, against a look into every list

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

}  // namespace
}  // namespace lacuna
