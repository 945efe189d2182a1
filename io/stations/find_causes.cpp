// SPDX-License-Identifier: Apache-2.0
#include "io/stations/find_causes.hpp"

#include "io/stations/inside_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr double kFarther = 1.02;  // of the farthest point: beyond the range
constexpr double kThrough = 0.05;  // share of longer ranges, of places without points
constexpr double kShadow = 0.2;    // hidden area over that of a floor without return: all is hidden
constexpr double kLevel = 0.7;     // cosine between the normal of a floor and the axis

enum class Finding { kSurface, kLeftOut, kFarther, kNothing, kNearer, kOutOfView };
constexpr std::size_t kFindings = 6;

// The finding of the least rank counts, among equal ones that of the nearest station.
int rank_of(Finding finding) {
  return std::min(static_cast<int>(finding), static_cast<int>(Finding::kNearer));
}

struct Sight {
  Finding finding = Finding::kOutOfView;
  double range = 0;                   // of the place
  Eigen::Vector3d measured{0, 0, 0};  // the point in its direction
  bool is_downward = false;
};

Sight look(const StationView& view, const InsidePlace& place, double tolerance) {
  const Eigen::Vector3d arm = place.position - view.station.place;
  const double range = arm.norm();
  if (!(range > 0)) return {};
  const Eigen::Vector3d direction = arm / range;
  const double cosine = std::fabs(direction.dot(place.normal));
  // Ranges of an inclined surface differ more: between rays, and where the place lies off the surface.
  const double angle = std::max(RangeImage::kCellAngle, view.step);
  const double near = (tolerance + 1.5 * angle * range) / std::max(cosine, kLeastIncidence);
  const double measured = view.ranges.at(direction);
  const auto is_near = [&](double other) { return other > 0 && std::fabs(other - range) <= near; };
  const auto finding = [&] {
    if (is_near(measured)) return Finding::kSurface;
    if (view.left_out && is_near(view.left_out->at(direction))) return Finding::kLeftOut;
    if (measured > 0 && measured < range) return Finding::kNearer;
    if (cosine < kLeastIncidence || range > kFarther * view.farthest || !view.field.contains(direction))
      return Finding::kOutOfView;
    return measured > 0 ? Finding::kFarther : Finding::kNothing;
  }();
  return {finding, range, view.station.place + measured * direction, direction.dot(view.station.axis) < 0};
}

struct Hider {
  Eigen::Vector3d point;
  std::int32_t station;
};

// What the stations find at all places of a hole.
class Findings {
 public:
  void add(const InsidePlace& place, std::span<const StationView> views, double tolerance) {
    std::optional<std::size_t> first;
    Sight found;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].certainty() < StationView::kLeastCertain) continue;
      const Sight sight = look(views[i], place, tolerance);
      const auto key = [](const Sight& of) { return std::pair(rank_of(of.finding), of.range); };
      if (first && key(found) <= key(sight)) continue;
      first = i;
      found = sight;
    }
    if (!first || found.finding == Finding::kSurface) return;
    areas_[static_cast<std::size_t>(found.finding)] += place.area;
    const bool is_level = std::fabs(place.normal.dot(views[*first].station.axis)) > kLevel;
    if (found.finding == Finding::kNothing && is_level && found.is_downward)
      floor_without_return_ += place.area;
    if (found.finding == Finding::kNearer)
      hiders_.push_back({found.measured, static_cast<std::int32_t>(*first)});
  }

  LoopCause cause() const {
    const double all = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    LoopCause cause;
    if (!(all > 0)) return cause;
    const double farther = area_of(Finding::kFarther), nothing = area_of(Finding::kNothing);
    const bool is_through = farther >= kThrough * (farther + nothing);
    const double floor = is_through ? 0 : floor_without_return_;
    const double hidden = area_of(Finding::kNearer);
    const bool is_shadow = hidden > kShadow * floor;
    const auto set = [&](Cause of, double area) { cause.shares[static_cast<std::size_t>(of)] = area / all; };
    set(Cause::kHidden, hidden + (is_shadow ? floor : 0));
    set(Cause::kOpening, farther + nothing - floor);
    set(Cause::kOutOfView, area_of(Finding::kOutOfView));
    set(Cause::kNoReturn, is_shadow ? 0 : floor);
    set(Cause::kFiltered, area_of(Finding::kLeftOut));
    if (!hiders_.empty()) describe_hiders(cause);
    return cause;
  }

 private:
  double area_of(Finding finding) const { return areas_[static_cast<std::size_t>(finding)]; }

  // By the station that has the most of them.
  void describe_hiders(LoopCause& cause) const {
    std::map<std::int32_t, std::size_t> counts;
    for (const Hider& hider : hiders_) ++counts[hider.station];
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    cause.hidden_from = most->first;
    Eigen::AlignedBox3d box;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Hider& hider : hiders_) {
      if (hider.station != cause.hidden_from) continue;
      box.extend(hider.point);
      sum += hider.point;
    }
    const Eigen::Vector3d middle = sum / static_cast<double>(most->second);
    cause.hidden_by_extent = box.sizes().maxCoeff();
    double least = std::numeric_limits<double>::infinity();
    for (const Hider& hider : hiders_) {
      const double away = (hider.point - middle).squaredNorm();
      if (hider.station != cause.hidden_from || away >= least) continue;
      least = away;
      cause.hidden_by = hider.point;
    }
  }

  std::array<double, kFindings> areas_{};  // by finding
  double floor_without_return_ = 0;
  std::vector<Hider> hiders_;  // of the places that are hidden
};

}  // namespace

LoopCause cause_of(std::span<const InsidePlace> places, std::span<const StationView> views,
                   double tolerance) {
  Findings findings;
  for (const InsidePlace& place : places) findings.add(place, views, tolerance);
  return findings.cause();
}

double tolerance_of(const LoopMeasures& loop) {
  return 2 * loop.perimeter / static_cast<double>(loop.points);
}

void find_causes(StationViews& stations, FileScan& scan, const RunConfig& run, Detection& detection) {
  const TaskArena arena(static_cast<std::size_t>(run.threads));
  const std::span<const StationView> views = stations.complete(scan, arena);
  for (const StationView& view : views) detection.stations.push_back(summary_of(view));
  arena.for_each(detection.loops.size(), [&](std::size_t i) {
    LoopMeasures& loop = detection.loops[i];
    if (loop.kind != LoopKind::kHole || views.empty()) return;
    const std::vector<InsidePlace> places = inside_places(detection, i);
    loop.cause = cause_of(places, views, tolerance_of(loop));
    stations.note_touched(2 * places.size() * views.size());
    if (!loop.cause.main()) loop.cause = cause_of(places, views, 0);  // a coarse loop near all of the surface
  });
}

}  // namespace lacuna::io
