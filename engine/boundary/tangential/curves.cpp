// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/curves.hpp"

#include "engine/evaluate/totals.hpp"
#include "engine/store/row_numbers.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace lacuna::tangential {
namespace {

// Returns place i of the curve as it is read from `start` on, in either direction.
std::size_t place(std::size_t start, std::size_t i, bool forwards, std::size_t count) {
  return forwards ? (start + i) % count : (start + count - i) % count;
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

namespace {

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

}  // namespace lacuna::tangential
