// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/chains.hpp"

#include "engine/run/error.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace lacuna::tangential {
namespace {

// An end with its boundary edge, which exactly one other end of that scale shares. Chain c has the ends 2c
// and 2c + 1.
struct NumberedEnd {
  Row low, high;
  LocalIndex end;
  Scale scale;

  NumberedEnd(const ChainEnd& e, LocalIndex end, Scale scale)
      : low(std::min(e.own, e.foreign)), high(std::max(e.own, e.foreign)), end(end), scale(scale) {}
  NumberedEnd() = default;
  friend bool operator<(const NumberedEnd& a, const NumberedEnd& b) {
    return std::tie(a.low, a.high, a.scale, a.end) < std::tie(b.low, b.high, b.scale, b.end);
  }
};

// Fills in the end that shares the boundary edge of each end.
void join_ends(SortedRuns<NumberedEnd>& ends, std::span<LocalIndex> partners, Scratch& scratch) {
  std::optional<NumberedEnd> first;  // of two that share a boundary edge
  const auto fail = [] { fail_inconsistent("a boundary curve ends at the border of a tile"); };
  ends.for_each([&](const NumberedEnd& end) {
    scratch.trim();
    if (!first) {
      first = end;
      return;
    }
    if (first->low != end.low || first->high != end.high || first->scale != end.scale) fail();
    partners[first->end] = end.end;
    partners[end.end] = first->end;
    first.reset();
  });
  if (first) fail();
}

void read_points(const OpenChain& chain, bool forwards, const Column<CurvePoint>& points,
                 std::span<CurvePoint> to) {
  points.read(chain.first, to);
  if (!forwards) std::reverse(to.begin(), to.end());
}

// Follows chains to curves. `is_done`: by chain, zeros.
class ChainFollower {
 public:
  ChainFollower(std::span<const OpenChain> chains, std::span<const LocalIndex> partners,
                std::span<std::uint8_t> is_done, Scratch& scratch)
      : chains_(chains), partners_(partners), is_done_(is_done), scratch_(scratch) {}

  void for_each_curve(const Column<CurvePoint>& points, std::uint64_t budget, const VisitCurve& visit) {
    for (LocalIndex start = 0; start < chains_.size(); ++start) {
      if (is_done_[start]) continue;
      std::uint64_t count = 0;
      for_each_chain_from(start, [&](const OpenChain& chain, bool) { count += chain.count; });
      Scratch scratch(scratch_.folder(), budget);
      const std::span<CurvePoint> curve = scratch.array<CurvePoint>(count);
      std::span<CurvePoint> left = curve;
      for_each_chain_from(start, [&](const OpenChain& chain, bool forwards) {
        scratch.trim(chain.count * sizeof(CurvePoint));
        read_points(chain, forwards, points, left.first(chain.count));
        left = left.subspan(chain.count);
        is_done_[static_cast<std::size_t>(&chain - chains_.data())] = 1;
      });
      visit(curve, chains_[start].scale, scratch);
    }
  }

 private:
  template <class VisitChain>
  void for_each_chain_from(LocalIndex start, VisitChain&& visit) {
    LocalIndex entered = 2 * start;
    do {
      scratch_.trim();
      visit(chains_[entered / 2], entered % 2 == 0);
      entered = partners_[entered ^ 1];
    } while (entered / 2 != start);
  }

  std::span<const OpenChain> chains_;
  std::span<const LocalIndex> partners_;
  std::span<std::uint8_t> is_done_;
  Scratch& scratch_;
};

}  // namespace

void close_chains(const Stitch<OpenChain>::ForEachRecord& for_each_chain, std::uint64_t count,
                  const Column<CurvePoint>& points, std::uint64_t curve_budget, Scratch& scratch,
                  const VisitCurve& visit) {
  SortedRuns<NumberedEnd> ends(scratch.folder() / "chain-ends", scratch.budget() / 2);
  ends.reserve(2 * count);
  const std::span<OpenChain> chains = scratch.array<OpenChain>(count);
  LocalIndex number = 0;
  for_each_chain([&](const OpenChain& chain) {
    scratch.trim();
    chains[number] = chain;
    for (const LocalIndex side : {0, 1})
      ends.add(NumberedEnd(chain.ends[side], 2 * number + side, chain.scale));
    ++number;
  });
  const std::span<LocalIndex> partners = scratch.array<LocalIndex>(2 * count);
  join_ends(ends, partners, scratch);
  ChainFollower(chains, partners, scratch.array<std::uint8_t>(count), scratch)
      .for_each_curve(points, curve_budget, visit);
}

}  // namespace lacuna::tangential
