// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/curves.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna::tangential {
namespace {

// Ids are not rows: curves must be followed by rows.
PointId id_of(std::uint64_t row) {
  return PointId{1000 - row};
}

std::uint64_t row_of(const CurveStep& step) {
  return 1000 - value(step.id);
}

// The wedges of a closed curve, every second one written against its direction.
std::vector<Wedge> ring(const std::vector<std::uint64_t>& rows) {
  std::vector<Wedge> wedges;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row from{rows[(i + rows.size() - 1) % rows.size()]}, to{rows[(i + 1) % rows.size()]};
    if (i % 2 == 1) std::swap(from, to);
    wedges.push_back({id_of(rows[i]), Row{rows[i]}, from, to, 1, Scale::kFine});
  }
  return wedges;
}

std::vector<std::vector<CurveStep>> follow(std::vector<Wedge> wedges) {
  std::vector<std::vector<CurveStep>> curves;
  std::stable_sort(wedges.begin(), wedges.end(),
                   [](const Wedge& a, const Wedge& b) { return a.row < b.row; });
  follow_wedges(wedges, partners_of(wedges), [&](const WedgeChain& chain) {
    CHECK(chain.is_closed);
    curves.emplace_back();
    for (const LocalIndex w : chain.wedges) curves.back().push_back({wedges[w].id, w});
  });
  return curves;
}

std::vector<CurveStep> curve_of(const std::vector<std::uint64_t>& ids) {
  std::vector<CurveStep> curve;
  for (std::size_t i = 0; i < ids.size(); ++i) curve.push_back({PointId{ids[i]}, i});
  return curve;
}

// The results in memory, and in mapped arrays of no budget.
std::vector<CurveStep> normalised(const std::vector<CurveStep>& curve) {
  const ScratchFolder folder;
  Scratch scratch(folder.path(), 1 << 20);
  std::vector<CurveStep> turned(curve.size());
  normalise(curve, turned, scratch);
  return turned;
}

std::vector<std::vector<CurveStep>> split(const std::vector<CurveStep>& curve,
                                          std::uint64_t budget = 1 << 20) {
  const ScratchFolder folder;
  Scratch scratch(folder.path(), budget);
  std::vector<std::vector<CurveStep>> curves;
  const auto by_id = [](const CurveStep& step) {
    return std::array{static_cast<double>(value(step.id)), 0., 0.};
  };
  split_at_pinches(curve, by_id, scratch, [&](std::span<const CurveStep> simple) {
    curves.emplace_back(simple.begin(), simple.end());
  });
  return curves;
}

std::vector<std::uint64_t> ids(const std::vector<CurveStep>& curve) {
  std::vector<std::uint64_t> ids;
  for (const CurveStep& p : curve) ids.push_back(value(p.id));
  return ids;
}

TEST_CASE("curves that touch in a point stay apart") {
  std::vector<Wedge> wedges = ring({3, 9, 4, 8, 1, 7});
  const std::vector<Wedge> other = ring({9, 10, 11});
  wedges.insert(wedges.end(), other.begin(), other.end());
  const std::vector<std::vector<CurveStep>> curves = follow(wedges);
  REQUIRE(curves.size() == 2);
  CHECK(std::minmax({curves[0].size(), curves[1].size()}) == std::pair<std::size_t, std::size_t>(3, 6));
}

TEST_CASE(
    "a curve of which a part is elsewhere is an open chain, and its ends say by which edges it leaves") {
  std::vector<Wedge> wedges = ring({1, 2, 3, 4, 5});
  const std::vector<Wedge> other = ring({20, 21, 22});
  wedges.erase(wedges.begin() + 2);
  wedges.insert(wedges.end(), other.begin(), other.end());
  wedges.push_back({id_of(40), Row{40}, Row{41}, Row{42}, 1, Scale::kFine});  // alone in its tile
  const std::vector<WedgePartners> partners = partners_of(wedges);
  CHECK(std::count(partners[0].begin(), partners[0].end(), kNoIndex) == 0);
  CHECK(std::count(partners[1].begin(), partners[1].end(), kNoIndex) == 1);
  CHECK(std::count(partners[2].begin(), partners[2].end(), kNoIndex) == 1);
  std::vector<std::vector<Row>> open;  // with the points beyond
  std::vector<std::size_t> closed;
  follow_wedges(wedges, partners, [&](const WedgeChain& chain) {
    if (chain.is_closed) {
      closed.push_back(chain.wedges.size());
      return;
    }
    const auto beyond = [&](LocalIndex w, std::size_t side) {
      return side == 0 ? wedges[w].from : wedges[w].to;
    };
    open.push_back({beyond(chain.wedges.front(), chain.first_side)});
    for (const LocalIndex w : chain.wedges) open.back().push_back(wedges[w].row);
    open.back().push_back(beyond(chain.wedges.back(), chain.last_side));
  });
  CHECK(closed == std::vector<std::size_t>{3});
  for (std::vector<Row>& chain : open)
    if (chain.back() < chain.front()) std::reverse(chain.begin(), chain.end());
  std::sort(open.begin(), open.end());
  CHECK(open == std::vector<std::vector<Row>>{{Row{3}, Row{2}, Row{1}, Row{5}, Row{4}, Row{3}},
                                              {Row{41}, Row{40}, Row{42}}});
}

TEST_CASE("a curve is split where it passes a point again, into curves that pass each point once") {
  const auto parts = [](const std::vector<std::uint64_t>& curve) {
    std::vector<std::vector<std::uint64_t>> curves;
    for (const auto& simple : split(curve_of(curve))) curves.push_back(ids(simple));
    return curves;
  };
  using Curves = std::vector<std::vector<std::uint64_t>>;
  CHECK(parts({1, 2, 3, 4}) == Curves{{1, 2, 3, 4}});
  CHECK(parts({1, 2, 9, 8, 7, 2, 3}) == Curves{{2, 7, 8, 9}, {1, 2, 3}});
  CHECK(parts({1, 5, 4, 1, 2, 3}) == Curves{{1, 2, 3}, {1, 4, 5}});
  CHECK(parts({1, 6, 7, 8, 7, 6, 3}) == Curves{{7, 8}, {6, 7}, {1, 3, 6}});  // a spike, there and back
  CHECK(parts({1, 5, 2, 1, 5, 3}) == Curves{{1, 2, 5}, {1, 3, 5}});
  const auto both = split(curve_of({1, 2, 3, 2, 4}));
  REQUIRE(both.size() == 2);
  CHECK(both[1][1].wedge == 3);  // of the pass that stays on the curve
}

// Whatever the curve, its parts pass each point once and have all its points, the same in mapped arrays.
void check_random_curves(std::uint64_t seed, int rounds, int longest) {
  Random random(seed);
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::uint64_t> passed(std::size_t(random.whole(3, longest)));
    const auto points = static_cast<std::int64_t>(passed.size()) / random.whole(1, 8) + 3;
    for (auto& p : passed) p = static_cast<std::uint64_t>(random.whole(0, points));
    const std::vector<CurveStep> curve = curve_of(passed);
    const std::vector<std::vector<CurveStep>> parts = split(curve);
    std::vector<std::uint64_t> all;
    std::size_t wrong = 0;
    for (const auto& part : parts) {
      const std::vector<std::uint64_t> of_part = ids(part);
      wrong += std::set(of_part.begin(), of_part.end()).size() != of_part.size();
      wrong += of_part != ids(normalised(part));
      all.insert(all.end(), of_part.begin(), of_part.end());
    }
    std::sort(all.begin(), all.end());
    std::sort(passed.begin(), passed.end());
    CHECK(wrong == 0);
    CHECK(all == passed);
    const std::vector<std::vector<CurveStep>> mapped = split(curve, 1);
    const bool same = std::equal(parts.begin(), parts.end(), mapped.begin(), mapped.end(),
                                 [](const auto& a, const auto& b) { return ids(a) == ids(b); });
    CHECK(same);
  }
}

TEST_CASE("random curves are split into simple ones, in memory and in mapped files") {
  check_random_curves(11, 56, 200);
  check_random_curves(12, 1, 30'000);
}

TEST_CASE("wedges of both scales at the same points chain apart") {
  std::vector<Wedge> wedges = ring({1, 2, 3, 4, 5}), coarse = ring({1, 2, 4, 3, 5});
  for (Wedge& wedge : coarse) wedge.scale = Scale::kCoarse;
  wedges.insert(wedges.end(), coarse.begin(), coarse.end());
  const std::vector<std::vector<CurveStep>> curves = follow(wedges);
  REQUIRE(curves.size() == 2);
  const auto next_of_2 = [&](const std::vector<CurveStep>& curve) {
    std::set<std::uint64_t> next;
    for (std::size_t i = 0; i < 5; ++i) {
      if (row_of(curve[i]) != 2) continue;
      next = {row_of(curve[(i + 1) % 5]), row_of(curve[(i + 4) % 5])};
    }
    return next;
  };
  CHECK(std::set{next_of_2(curves[0]), next_of_2(curves[1])} ==
        std::set<std::set<std::uint64_t>>{{1, 3}, {1, 4}});
}

TEST_CASE(
    "loops along a curve have the means of its points, which are not even looked at where there is no "
    "surface") {
  const ScratchFolder folder;
  Scratch scratch(folder.path(), 1 << 20);
  const std::vector<CurveStep> curve = curve_of({1, 2, 3, 4, 5, 6, 7, 8});
  std::size_t points = 0;
  WedgeData data{.point =
                     [&](std::uint64_t w) {
                       ++points;
                       CurvePoint point{};
                       point.evidence = {
                           .length = 1, .sampling_radius = double(w), .distance = 2, .clearness = 1};
                       return point;
                     },
                 .surface = [](std::uint64_t w) { return w < 4 ? 0.2F : 0.6F; }};
  std::vector<LoopEvidence> found;
  const auto find = [&] {
    find_loops_along(curve, Scale::kFine, data, {.added_length = 0, .min_curve = 8}, scratch,
                     [&](std::span<const CurveStep> loop, const LoopEvidence& evidence) {
                       CHECK(loop.size() == 8);
                       found.push_back(evidence);
                     });
  };
  find();
  REQUIRE(found.size() == 1);
  CHECK(found[0].surface == Approx(0.4));
  CHECK(found[0].sampling_gap == Approx(3.5 / 2));
  CHECK(points == 8);
  data.surface = [](std::uint64_t) { return 0.2F; };
  find();
  CHECK(found.size() == 1);
  CHECK(points == 8);
}

TEST_CASE("a tile keeps its open chains with the components that they are of, and counts what is closed") {
  // Two rings that touch in a point, of which one lacks a wedge; a ring that lacks one; a whole ring.
  std::vector<Wedge> wedges = ring({1, 2, 3, 4});
  for (const auto& rows : {std::vector<std::uint64_t>{1, 5, 6, 7}, {11, 12, 13}, {21, 22, 23}}) {
    const std::vector<Wedge> more = ring(rows);
    wedges.insert(wedges.end(), more.begin(), more.end());
  }
  std::erase_if(wedges, [](const Wedge& w) { return w.row == Row{6} || w.row == Row{12}; });
  std::stable_sort(wedges.begin(), wedges.end(),
                   [](const Wedge& a, const Wedge& b) { return a.row < b.row; });
  std::vector<std::size_t> closed;
  const OpenChains open = follow_curves(
      wedges,
      [&](std::uint64_t w) {
        CurvePoint point{};
        point.id = wedges[w].id;
        return point;
      },
      [&](std::span<const CurveStep> curve, Scale) { closed.push_back(curve.size()); });
  std::sort(closed.begin(), closed.end());
  CHECK(closed == std::vector<std::size_t>{3, 4});
  REQUIRE(open.chains.size() == 2);
  CHECK(open.components == std::vector<LocalIndex>{0, 1});
  CHECK(open.totals.components == 1);  // the ring that touches an open one is of its component
  CHECK(open.totals.edges == wedges.size());
  CHECK(open.points.size() == open.chains[0].count + open.chains[1].count);
  for (const OpenChain& chain : open.chains) {
    const Row missing = chain.ends[0].foreign;
    CHECK((missing == Row{6} || missing == Row{12}));
    CHECK(chain.ends[1].foreign == missing);
  }
}

}  // namespace
}  // namespace lacuna::tangential
