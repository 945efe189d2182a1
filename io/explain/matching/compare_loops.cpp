// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/compare_loops.hpp"

#include "engine/loops/loop_plane.hpp"
#include "engine/stitch/components.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

namespace lacuna::matching {
namespace {

// The points of all loops.
struct Curves {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> tolerances;
};

// Appends the points of loops to the curves; returns the loops by place there.
std::vector<LoopIds> place(std::span<const ComparedLoop> loops, Curves& curves) {
  std::vector<LoopIds> placed;
  for (const ComparedLoop& loop : loops) {
    LoopIds& ids = placed.emplace_back();
    for (const Eigen::Vector3d& point : loop.points) {
      ids.push_back(curves.positions.size());
      curves.positions.push_back(point);
      curves.tolerances.push_back(loop.tolerance);
    }
  }
  return placed;
}

// Whether a loop is of the same hole, or of a part of it: half of one runs along the other.
bool is_related(const LoopMatch& match) {
  constexpr double kHalf = 0.5;
  return match.true_loop &&
         (match.verdict != EdgeDecision::kFalse || match.on >= kHalf || match.covered >= kHalf);
}

// A loop runs through the points around its hole, so it may lie half of a spacing off all along.
bool is_as_large(const LoopMeasures& a, const LoopMeasures& b) {
  constexpr double kTenth = 0.1, kHalf = 0.5;
  const double tenth = kTenth * std::max(a.area, b.area);
  const double margin = kHalf * std::max(a.perimeter, b.perimeter) *
                        std::max(a.track.evidence.spacing, b.track.evidence.spacing);
  return std::abs(a.area - b.area) <= std::max(tenth, margin);
}

// The surface of the other scan where one result alone has a loop.
enum class Surface { kThere, kEmpty, kUnknown };

// A loop in the plane of its normal.
struct FlatLoop {
  LoopPlane plane;
  std::vector<Eigen::Vector2d> polygon;
  std::vector<double> heights;  // over the plane
};

// Returns nothing for a loop that encloses no area.
std::optional<FlatLoop> flattened(const ComparedLoop& loop) {
  const Eigen::Vector3d& normal = loop.measures.normal;
  if (!(normal.norm() > 0.5)) return std::nullopt;
  FlatLoop flat{LoopPlane(loop.points[0], normal, normal.unitOrthogonal()), {}, {}};
  for (const Eigen::Vector3d& point : loop.points) {
    const Eigen::Vector3d at = flat.plane(point);
    flat.polygon.push_back(at.head<2>());
    flat.heights.push_back(at.z());
  }
  return flat;
}

// Returns places over the loop at its height, weighted by the inverse squared distance.
std::vector<Eigen::Vector3d> places_over(const FlatLoop& loop) {
  constexpr std::size_t kMost = 64;
  constexpr double kLeast = 1e-300;
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector2d& place : places_within(std::span<const Eigen::Vector2d>(loop.polygon), kMost)) {
    double weights = 0, sum = 0;
    for (std::size_t i = 0; i < loop.polygon.size(); ++i) {
      const double weight = 1 / std::max((loop.polygon[i] - place).squaredNorm(), kLeast);
      weights += weight;
      sum += weight * loop.heights[i];
    }
    places.push_back(loop.plane.point_at({place.x(), place.y(), sum / weights}));
  }
  return places;
}

// Returns places outside of the loop: one for each of its edges, at a distance.
std::vector<Eigen::Vector3d> places_beyond(const FlatLoop& loop, double distance) {
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < loop.polygon.size(); ++i) {
    const Eigen::Vector2d& a = loop.polygon[i];
    const Eigen::Vector2d along = loop.polygon[(i + 1) % loop.polygon.size()] - a;
    const Eigen::Vector2d aside = distance * Eigen::Vector2d(along.y(), -along.x()).stableNormalized();
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(a + aside), Eigen::Vector2d(a - aside)}) {
      if (!is_inside(std::span<const Eigen::Vector2d>(loop.polygon), place))
        places.push_back(loop.plane.point_at({place.x(), place.y(), loop.heights[i]}));
    }
  }
  return places;
}

double share_within(std::span<const Eigen::Vector3d> places, const PointTree& points, double reach) {
  const auto near = std::count_if(places.begin(), places.end(), [&](const Eigen::Vector3d& place) {
    return points.nearest_distance(place) <= reach;
  });
  return static_cast<double>(near) / static_cast<double>(places.size());
}

// `sample`: the points of `other`.
Surface surface_over(const ComparedLoop& loop, const ComparedScan& other, const PointTree& sample) {
  constexpr double kHalf = 0.5, kReach = 1.5;  // spacings
  const double reach = kReach * other.spacing;
  if (other.sample.empty() || loop.points.empty() || share_within(loop.points, sample, 2 * reach) < kHalf)
    return Surface::kUnknown;
  const PointTree rim(loop.points);
  const std::optional<FlatLoop> flat = flattened(loop);
  if (!flat) return Surface::kUnknown;
  std::vector<Eigen::Vector3d> places =
      loop.measures.kind == LoopKind::kHole ? places_over(*flat) : places_beyond(*flat, 2 * reach);
  std::erase_if(places, [&](const Eigen::Vector3d& place) { return rim.nearest_distance(place) <= reach; });
  if (places.empty()) return Surface::kUnknown;
  return share_within(places, sample, reach) >= kHalf ? Surface::kThere : Surface::kEmpty;
}

// Sets of loops of both results that belong together: the loops of `before` come first.
class Related {
 public:
  Related(std::size_t before, std::size_t after) : before_(before), links_(before + after), sets_(links_) {}

  void unite(std::size_t before, std::size_t after) {
    sets_.unite(static_cast<LocalIndex>(before), static_cast<LocalIndex>(before_ + after));
  }
  // Returns the sets in the order of their first loop of the second result, then of the first one.
  std::vector<LoopChange> changes() {
    std::vector<LoopChange> changes;
    std::map<LocalIndex, std::size_t> place_of;
    const auto change_of = [&](std::size_t loop) -> LoopChange& {
      const auto [at, is_new] = place_of.emplace(sets_.find(static_cast<LocalIndex>(loop)), changes.size());
      return is_new ? changes.emplace_back() : changes[at->second];
    };
    for (std::size_t i = before_; i < links_.size(); ++i) change_of(i).after.push_back(i - before_);
    for (std::size_t i = 0; i < before_; ++i) change_of(i).before.push_back(i);
    return changes;
  }

 private:
  std::size_t before_;
  std::vector<LocalIndex> links_;
  UnionFind sets_;
};

}  // namespace

std::string_view name_of(Change change) {
  constexpr std::string_view kNames[] = {"same",   "changed",   "closed",        "not found now",
                                         "opened", "found now", "not comparable"};
  return kNames[static_cast<std::size_t>(change)];
}

std::vector<LoopChange> compare_loops(const ComparedScan& before, const ComparedScan& after,
                                      double tolerance) {
  Curves curves;
  const std::vector<LoopIds> first = place(before.loops, curves), second = place(after.loops, curves);
  const MatchRule rule{.tolerance = tolerance, .of_place = curves.tolerances, .min_vertices = 0};
  const std::vector<std::uint64_t> same_places = stand_ins(curves.positions);
  const auto matches = [&](std::span<const LoopIds> loops, std::span<const LoopIds> others) {
    const std::vector<TrueLoop> truth = loops_through(others, same_places);
    return match_loops(loops, truth, curves.positions, rule).loops;
  };
  const std::vector<LoopMatch> onto_before = matches(second, first), onto_after = matches(first, second);
  Related related(first.size(), second.size());
  for (std::size_t a = 0; a < second.size(); ++a) {
    if (is_related(onto_before[a])) related.unite(*onto_before[a].true_loop, a);
  }
  for (std::size_t b = 0; b < first.size(); ++b) {
    if (is_related(onto_after[b])) related.unite(b, *onto_after[b].true_loop);
  }

  const PointTree sample_before(before.sample), sample_after(after.sample);
  const auto is_same = [&](std::size_t b, std::size_t a) {
    const EdgeDecision verdict = onto_before[a].verdict;
    return (verdict == EdgeDecision::kFound || verdict == EdgeDecision::kRepeated) &&
           is_as_large(before.loops[b].measures, after.loops[a].measures);
  };
  std::vector<LoopChange> changes = related.changes();
  for (LoopChange& c : changes) {
    const auto alone = [&](Surface surface, Change there, Change empty) {
      return surface == Surface::kThere ? there : surface == Surface::kEmpty ? empty : Change::kNotComparable;
    };
    if (c.before.empty()) {
      c.change = alone(surface_over(after.loops[c.after[0]], before, sample_before), Change::kOpened,
                       Change::kFoundNow);
    } else if (c.after.empty()) {
      c.change = alone(surface_over(before.loops[c.before[0]], after, sample_after), Change::kClosed,
                       Change::kNotFoundNow);
    } else {
      const bool is_pair = c.before.size() == 1 && c.after.size() == 1;
      c.change = is_pair && is_same(c.before[0], c.after[0]) ? Change::kSame : Change::kChanged;
    }
  }
  return changes;
}

}  // namespace lacuna::matching
