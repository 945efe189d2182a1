// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/curves.hpp"

#include "engine/evaluate/totals.hpp"
#include "engine/run/error.hpp"
#include "engine/stitch/components.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace lacuna::tangential {

// ---- From wedge to wedge

std::vector<WedgePartners> partners_of(std::span<const Wedge> wedges) {
  RowNumbers points;
  points.collect(wedges.size(), [&](auto&& add) {
    for (const Wedge& wedge : wedges) add(wedge.row);
  });
  std::vector<LocalIndex> begins(points.size() + 1);  // of each point's wedges
  for (const Wedge& wedge : wedges) ++begins[points.number(wedge.row) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());

  // Returns the wedge at `point` with an edge to `neighbour`: at each scale there is at most one.
  const auto find = [&](Row point, Row neighbour, Scale scale) {
    const std::optional<LocalIndex> number = points.find(point);
    if (!number) return kNoIndex;
    for (LocalIndex i = begins[*number]; i < begins[*number + 1]; ++i) {
      if (wedges[i].scale == scale && (wedges[i].from == neighbour || wedges[i].to == neighbour)) return i;
    }
    return kNoIndex;
  };
  std::vector<WedgePartners> partners;
  partners.reserve(wedges.size());
  for (const Wedge& wedge : wedges)
    partners.push_back({find(wedge.from, wedge.row, wedge.scale), find(wedge.to, wedge.row, wedge.scale)});
  return partners;
}

void follow_wedges(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                   const std::function<void(const WedgeChain&)>& visit) {
  std::vector<bool> is_done(wedges.size());
  std::vector<LocalIndex> numbers;
  // Leaves the first wedge by the other side.
  const auto follow = [&](LocalIndex start, std::size_t first_side) {
    numbers.clear();
    std::size_t side = 1 - first_side;
    for (LocalIndex at = start;;) {
      is_done[at] = true;
      numbers.push_back(at);
      const LocalIndex next = partners[at][side];
      if (next == kNoIndex || is_done[next]) {
        visit({numbers, next != kNoIndex, first_side, side});
        return;
      }
      side = wedges[next].from == wedges[at].row ? 1 : 0;
      at = next;
    }
  };
  for (LocalIndex start = 0; start < wedges.size(); ++start) {
    for (const std::size_t side : {0, 1}) {
      if (!is_done[start] && partners[start][side] == kNoIndex) follow(start, side);
    }
  }
  for (LocalIndex start = 0; start < wedges.size(); ++start) {
    if (!is_done[start]) follow(start, 0);
  }
}

// ---- From a closed curve to loops

namespace {

// Returns place i of the curve as it is read from `start` on, in either direction.
std::size_t place(std::size_t start, std::size_t i, bool forwards, std::size_t count) {
  return forwards ? (start + i) % count : (start + count - i) % count;
}

// Writes the closed curve by the way whose keys come first. key_of(step): an id, or a place.
template <class KeyOf>
void write_first_way(std::span<const CurveStep> curve, std::span<CurveStep> turned, Scratch& scratch,
                     const KeyOf& key_of) {
  struct Way {
    std::size_t start;
    bool forwards;
  };
  const std::size_t count = curve.size();
  const auto at = [&](const Way& way, std::size_t i) -> const CurveStep& {
    scratch.trim(sizeof(CurveStep));
    return curve[place(way.start, i, way.forwards, count)];
  };
  const auto comes_first = [&](const Way& a, const Way& b) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto of_a = key_of(at(a, i)), of_b = key_of(at(b, i));
      if (of_a != of_b) return of_a < of_b;
    }
    return false;
  };
  auto least = key_of(curve.front());
  scratch.for_each(curve, [&](const CurveStep& p) { least = std::min(least, key_of(p)); });
  std::optional<Way> best;
  for (std::size_t start = 0; start < count; ++start) {
    if (key_of(at({start, true}, 0)) != least) continue;
    for (const bool forwards : {true, false}) {
      const Way way{start, forwards};
      if (!best || comes_first(way, *best)) best = way;
    }
  }
  for (std::size_t i = 0; i < count; ++i) turned[i] = at(*best, i);
}

// Returns the points that a curve passes more than once, ascending.
std::span<const PointId> repeated_points(std::span<const CurveStep> curve, Scratch& scratch) {
  SortedRuns<PointId> ids(scratch.folder() / "curve-ids", scratch.budget() / 4);
  scratch.for_each(curve, [&](const CurveStep& p) { ids.add(p.id); });
  const std::span<PointId> repeated = scratch.array<PointId>(curve.size() / 2);
  std::size_t count = 0;
  std::optional<PointId> before;
  ids.for_each([&](PointId id) {
    scratch.trim(sizeof(PointId));
    if (before == id && (count == 0 || repeated[count - 1] != id)) repeated[count++] = id;
    before = id;
  });
  return repeated.first(count);
}

}  // namespace

void normalise(std::span<const CurveStep> curve, std::span<CurveStep> turned, Scratch& scratch) {
  write_first_way(curve, turned, scratch, [](const CurveStep& step) { return step.id; });
}

void split_at_pinches(std::span<const CurveStep> curve, const PlaceOfStep& place_of_step, Scratch& scratch,
                      const std::function<void(std::span<const CurveStep>)>& visit) {
  const std::span<CurveStep> whole = scratch.array<CurveStep>(curve.size());
  const std::span<const PointId> repeated = repeated_points(curve, scratch);
  if (repeated.empty()) {
    normalise(curve, whole, scratch);
    visit(whole);
    return;
  }
  write_first_way(curve, whole, scratch, place_of_step);
  // For each repeated point, this is 1 + its place on the path, or 0 if it is not on the path.
  const std::span<std::uint32_t> places = scratch.array<std::uint32_t>(repeated.size());
  const auto place_of = [&](const CurveStep& p) -> std::uint32_t* {
    const auto at = std::lower_bound(repeated.begin(), repeated.end(), p.id);
    return at != repeated.end() && *at == p.id ? &places[static_cast<std::size_t>(at - repeated.begin())]
                                               : nullptr;
  };
  const std::span<CurveStep> path = scratch.array<CurveStep>(curve.size()),
                             turned = scratch.array<CurveStep>(curve.size());
  std::uint32_t size = 0;  // of the path
  const auto split_off = [&](std::uint32_t begin) {
    const auto part = path.subspan(begin, size - begin);
    normalise(part, turned, scratch);
    visit(turned.first(part.size()));
    scratch.for_each(part, [&](const CurveStep& p) {
      scratch.trim();
      if (std::uint32_t* const place = place_of(p); place != nullptr) *place = 0;
    });
    size = begin;
  };
  scratch.for_each(whole, [&](const CurveStep& p) {
    scratch.trim();
    std::uint32_t* const place = place_of(p);
    if (place != nullptr && *place != 0) split_off(*place - 1);
    path[size++] = p;
    if (place != nullptr) *place = size;
  });
  split_off(0);
}

LoopEvidence evidence_of(std::span<const CurveStep> curve, Scale scale, const WedgeData& data,
                         const TangentialConfig& config, Scratch& scratch) {
  const auto points = static_cast<double>(curve.size());
  double surface = 0;
  scratch.for_each(curve, [&](const CurveStep& step) { surface += data.surface(step.wedge); });
  LoopEvidence evidence{.surface = surface / points, .is_coarse = scale == Scale::kCoarse};
  if (!evidence.may_be_hole()) return evidence;
  double clear = 0, length = 0, sampling_radii = 0, distances = 0;
  scratch.for_each(curve, [&](const CurveStep& step) {
    const WedgeEvidence at = data.point(step.wedge).evidence;
    clear += at.clearness * at.length;
    length += at.length;
    sampling_radii += at.sampling_radius;
    distances += at.distance;
  });
  evidence.clearness = clear / (length + config.added_length * sampling_radii / points);
  evidence.spacing = distances / points / kDistanceOverSpacing;
  evidence.sampling_gap = sampling_radii / distances;
  return evidence;
}

void find_loops_along(std::span<const CurveStep> curve, Scale scale, const WedgeData& data,
                      const TangentialConfig& config, Scratch& scratch,
                      const std::function<void(std::span<const CurveStep>, const LoopEvidence&)>& visit) {
  const auto least = static_cast<std::size_t>(config.min_curve);
  if (curve.size() < least) return;
  const auto place_of = [&](const CurveStep& step) {
    const CurvePoint point = data.point(step.wedge);
    return std::array{-point.x, -point.y, -point.z};
  };
  split_at_pinches(curve, place_of, scratch, [&](std::span<const CurveStep> simple) {
    if (simple.size() < least) return;
    const LoopEvidence evidence = evidence_of(simple, scale, data, config, scratch);
    if (evidence.may_be_hole()) visit(simple, evidence);
  });
}

// ---- The curves of one tile

namespace {

constexpr RecordStream<OpenChain> kChains{"chains"};
constexpr RecordStream<LocalIndex> kComponents{"components of chains"};
constexpr RecordStream<CurvePoint> kChainPoints{"points of chains"};
constexpr RecordStream<CurveTotals> kCurveTotals{"totals of curves"};
constexpr RecordStream<TileLoops::Entry> kLoops{"loops"};
constexpr RecordStream<LoopPoint> kLoopPoints{"points of loops"};

// Returns the links of a union-find over chains. Wedges of one point, which are next to each other, connect
// the chains that they are on.
std::vector<LocalIndex> connect_chains(std::span<const Wedge> wedges, std::span<const LocalIndex> chain_of,
                                       LocalIndex chains) {
  std::vector<LocalIndex> links(chains);
  UnionFind connected(links);
  for (std::size_t i = 1; i < wedges.size(); ++i) {
    if (wedges[i].row == wedges[i - 1].row) connected.unite(chain_of[i - 1], chain_of[i]);
  }
  return links;
}

// Numbers the components that have an open chain, and counts the others. `open`: the numbers of open chains.
void number_components(std::vector<LocalIndex> links, std::span<const LocalIndex> open, OpenChains& found) {
  UnionFind connected(links);
  std::vector<LocalIndex> number_of(links.size(), kNoIndex);  // by root
  LocalIndex numbers = 0;
  for (const LocalIndex chain : open) {
    LocalIndex& number = number_of[connected.find(chain)];
    if (number == kNoIndex) number = numbers++;
    found.components.push_back(number);
  }
  for (LocalIndex chain = 0; chain < links.size(); ++chain)
    found.totals.components += connected.find(chain) == chain && number_of[chain] == kNoIndex ? 1 : 0;
}

}  // namespace

OpenChains follow_curves(std::span<const Wedge> wedges,
                         const std::function<CurvePoint(std::uint64_t)>& point_of,
                         const std::function<void(std::span<const CurveStep>, Scale)>& visit) {
  OpenChains found;
  // Each wedge ends at two edges, each edge at two wedges.
  found.totals.edges = static_cast<std::uint64_t>(std::ranges::count(wedges, Scale::kFine, &Wedge::scale));
  std::vector<LocalIndex> chain_of(wedges.size()), open;
  LocalIndex chains = 0;
  std::vector<CurveStep> curve;
  follow_wedges(wedges, partners_of(wedges), [&](const WedgeChain& chain) {
    const LocalIndex number = chains++;
    for (const LocalIndex w : chain.wedges) chain_of[w] = number;
    const Scale scale = wedges[chain.wedges.front()].scale;
    if (chain.is_closed) {
      curve.clear();
      for (const LocalIndex w : chain.wedges) curve.push_back({wedges[w].id, w});
      return visit(curve, scale);
    }
    const auto end = [&](LocalIndex w, std::size_t side) {
      return ChainEnd{wedges[w].row, side == 0 ? wedges[w].from : wedges[w].to};
    };
    open.push_back(number);
    found.chains.push_back(
        {found.points.size(),
         chain.wedges.size(),
         scale,
         {end(chain.wedges.front(), chain.first_side), end(chain.wedges.back(), chain.last_side)}});
    for (const LocalIndex w : chain.wedges) found.points.push_back(point_of(w));
  });
  number_components(connect_chains(wedges, chain_of, chains), open, found);
  return found;
}

void OpenChains::emit(TileOutput& output) && {
  output.add(kChains, std::move(chains));
  output.add(kComponents, std::move(components));
  output.add(kChainPoints, std::move(points));
  output.add(kCurveTotals, std::vector<CurveTotals>{totals});
}

OpenChains OpenChains::read(const TileOutputs& outputs, TileIndex tile) {
  OpenChains open{
      outputs.read(kChains, tile), outputs.read(kComponents, tile), outputs.read(kChainPoints, tile), {}};
  for (const CurveTotals& totals : outputs.read(kCurveTotals, tile)) open.totals = totals;
  return open;
}

std::uint64_t OpenChains::bytes(const TileOutputs& outputs, TileIndex tile) {
  return outputs.count(kChains, tile) * (sizeof(OpenChain) + sizeof(LocalIndex)) +
         outputs.count(kChainPoints, tile) * sizeof(CurvePoint);
}

void TileLoops::emit(TileOutput& output) && {
  output.add(kLoops, std::move(loops));
  output.add(kLoopPoints, std::move(points));
}

TileLoops TileLoops::read(const TileOutputs& outputs, TileIndex tile) {
  return {outputs.read(kLoops, tile), outputs.read(kLoopPoints, tile)};
}

std::uint64_t TileLoops::bytes(const TileOutputs& outputs, TileIndex tile) {
  return outputs.count(kLoops, tile) * sizeof(Entry) + outputs.count(kLoopPoints, tile) * sizeof(LoopPoint);
}

// ---- Across tiles

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
