// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/find_causes.hpp"

#include "io/explain/lids/make_lid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace lacuna::io {
namespace {

constexpr std::uint64_t kMostCorners = 64;  // of a loop that is triangulated
constexpr std::uint64_t kMostIslandCorners = 16;
constexpr double kPlaces = 256;  // of a hole, at least

// Spreads places evenly over the triangles, by the sequence R2 (Roberts, 2018).
std::vector<InnerSample> places_inside(const LidMesh& mesh) {
  const double spacing = area(mesh) / kPlaces;
  std::vector<InnerSample> places;
  if (!(spacing > 0)) return places;
  for (const LidTriangle& triangle : mesh.triangles) {
    const Eigen::Vector3d vector = area_vector(mesh, triangle);
    const double size = vector.norm();
    if (!(size > 0)) continue;
    const auto count = static_cast<std::size_t>(std::ceil(size / spacing));
    const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
    const Eigen::Vector3d to_b = mesh.vertices[triangle[1]] - a, to_c = mesh.vertices[triangle[2]] - a;
    for (std::size_t i = 1; i <= count; ++i) {
      const double n = static_cast<double>(i);
      double u = 0.5 + n * 0.7548776662466927, v = 0.5 + n * 0.5698402909980532;
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      places.push_back({a + u * to_b + v * to_c, vector / size, size / static_cast<double>(count)});
    }
  }
  return places;
}

// Returns `most` points of the loop at even steps, or all if it has fewer.
std::vector<Eigen::Vector3d> some_corners(const Detection& detection, const InnerRing& loop,
                                          std::uint64_t most) {
  const std::uint64_t count = std::min(loop.points, most);
  std::vector<Eigen::Vector3d> corners;
  std::uint64_t at = 0;
  detection.for_each_loop_point(loop.loop, [&](const LoopPoint& point) {
    if (corners.size() < count && at++ >= corners.size() * loop.points / count)
      corners.push_back(point.position());
  });
  return corners;
}

}  // namespace

std::vector<InnerSample> inside_places(const Detection& detection, std::size_t loop) {
  const std::span<const InnerRing> islands = detection.inner_rings_of(loop);
  std::vector<Eigen::Vector3d> corners =
      some_corners(detection, {loop, detection.loops[loop].points}, kMostCorners);
  if (islands.empty() || corners.size() < 3) return inside_places(corners);
  std::vector<std::size_t> sizes = {corners.size()};
  for (const InnerRing& island : islands.first(std::min(islands.size(), kMostIslands))) {
    const std::vector<Eigen::Vector3d> ring = some_corners(detection, island, kMostIslandCorners);
    corners.insert(corners.end(), ring.begin(), ring.end());
    sizes.push_back(ring.size());
  }
  std::vector<InnerSample> places = places_inside(triangulate_rings(corners, sizes));
  return places.empty() ? inside_places(std::span(corners).first(sizes[0])) : places;
}

std::vector<InnerSample> inside_places(std::span<const Eigen::Vector3d> loop) {
  const std::size_t count = std::min<std::size_t>(loop.size(), kMostCorners);
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t i = 0; i < count; ++i) corners.push_back(loop[i * loop.size() / count]);
  return count < 3 ? std::vector<InnerSample>() : places_inside(triangulate_polygon(corners));
}

namespace {

constexpr double kFarther = 1.02;  // of the farthest point: beyond the range
constexpr double kThrough = 0.05;  // share of longer ranges, of places without points
constexpr double kShadow =
    0.2;  // hidden area over the area of floors without return, from which on both are hidden
constexpr double kLevel = 0.7;              // cosine between the normal of a floor and the axis
constexpr std::uint64_t kPagesAround = 16;  // that the system maps where one of an image is read

enum class Finding { kSurface, kLeftOut, kFarther, kNothing, kNearer, kOutOfView };
constexpr std::size_t kFindings = 6;

// The finding of the least rank counts; among equal ranks, the finding of the nearest station.
int rank_of(Finding finding) {
  return std::min(static_cast<int>(finding), static_cast<int>(Finding::kNearer));
}

struct Sight {
  Finding finding = Finding::kOutOfView;
  double range = 0;                   // of the place
  Eigen::Vector3d measured{0, 0, 0};  // the point in its direction
  Eigen::Vector3d eye{0, 0, 0};
  bool is_floor = false;  // the place is on a level surface below the scanner
  std::int32_t station = 0;
};

// It measures as far as `farthest`, with this angle between rays. `axis`: upwards.
// `may_return`: it sends rays in this direction.
struct Scanner {
  double angle, farthest;
  Eigen::Vector3d axis;
  bool may_return;
};

Sight look(const Aim& aim, const Scanner& scanner, const InnerSample& place, double tolerance) {
  const double range = aim.range, measured = aim.measured;
  if (!(range > 0)) return {};
  const double cosine = std::fabs(aim.direction.dot(place.normal));
  // Ranges of an inclined surface differ more: between rays, and where the place lies off the surface.
  const double near = (tolerance + 1.5 * scanner.angle * range) / std::max(cosine, kLeastIncidence);
  const auto is_near = [&](double other) { return other > 0 && std::fabs(other - range) <= near; };
  const auto finding = [&] {
    if (is_near(measured)) return Finding::kSurface;
    if (is_near(aim.left_out)) return Finding::kLeftOut;
    if (measured > 0 && measured < range) return Finding::kNearer;
    if (cosine < kLeastIncidence || range > kFarther * scanner.farthest || !scanner.may_return)
      return Finding::kOutOfView;
    return measured > 0 ? Finding::kFarther : Finding::kNothing;
  }();
  return {
      .finding = finding,
      .range = range,
      .measured = aim.eye + measured * aim.direction,
      .eye = aim.eye,
      .is_floor = std::fabs(place.normal.dot(scanner.axis)) > kLevel && aim.direction.dot(scanner.axis) < 0};
}

Sight look(const StationView& view, const InnerSample& place, double tolerance) {
  const Eigen::Vector3d arm = place.position - view.station.place;
  const double range = arm.norm();
  if (!(range > 0)) return {};
  const Eigen::Vector3d direction = arm / range;
  const Aim aim{.eye = view.station.place,
                .direction = direction,
                .range = range,
                .measured = view.ranges.at(direction),
                .left_out = view.left_out ? view.left_out->at(direction) : 0};
  const Scanner scanner{.angle = std::max(cell_angle(RangeImage::kEdge), view.step),
                        .farthest = view.farthest,
                        .axis = view.station.axis,
                        .may_return = view.field.contains(direction)};
  return look(aim, scanner, place, tolerance);
}

// What the scanners find at all places of a hole.
class Findings {
 public:
  Findings(std::span<const StationView> views, const PathView* path, const Eigen::AlignedBox3d& hole)
      : views_(views), path_(path && is_certain(*path) ? path : nullptr) {
    if (path_) sections_ = path_->sections_near(hole, kFarther * path_->farthest());
    for (std::size_t i = 0; i < views.size(); ++i)
      if (is_certain(views[i])) stations_.push_back(static_cast<std::int32_t>(i));
  }

  void add(const InnerSample& place, double tolerance) {
    if (stations_.empty() && !path_) return;
    std::optional<Sight> found;
    const auto take = [&](const Sight& sight) {
      const auto key = [](const Sight& of) { return std::pair(rank_of(of.finding), of.range); };
      if (!found || key(sight) < key(*found)) found = sight;
    };
    for (const std::int32_t station : stations_) {
      Sight sight = look(views_[static_cast<std::size_t>(station)], place, tolerance);
      sight.station = station;
      take(sight);
    }
    if (path_) {
      const Scanner scanner{.angle = cell_angle(PathView::kEdge),
                            .farthest = path_->farthest(),
                            .axis = Eigen::Vector3d::UnitZ(),
                            .may_return = true};
      for (const Aim& aim : path_->aims_at(place.position, sections_))
        take(look(aim, scanner, place, tolerance));
    }
    const Sight sight = found.value_or(Sight());
    if (sight.finding == Finding::kSurface) return;
    areas_[static_cast<std::size_t>(sight.finding)] += place.area;
    if (sight.finding == Finding::kNothing && sight.is_floor) floor_without_return_ += place.area;
    if (sight.finding == Finding::kNearer) hiders_.push_back({sight.measured, sight.eye, sight.station});
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

  template <class View>
  static bool is_certain(const View& view) {
    return view.certainty() >= StationView::kLeastCertain;
  }

  // Describes the hiders of the station that has the most of them.
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
      cause.hidden_from_place = hider.eye;
    }
  }

  struct Hider {
    Eigen::Vector3d point, eye;
    std::int32_t station;
  };

  std::span<const StationView> views_;
  const PathView* path_;                   // null: no scanner moves
  std::vector<std::uint32_t> sections_;    // of the path
  std::vector<std::int32_t> stations_;     // views that are certain
  std::array<double, kFindings> areas_{};  // by finding
  double floor_without_return_ = 0;
  std::vector<Hider> hiders_;  // of the places that are hidden
};

}  // namespace

LoopCause cause_of(std::span<const InnerSample> places, std::span<const StationView> views,
                   const PathView* path, double tolerance, const std::function<void()>& after_place) {
  Eigen::AlignedBox3d hole;
  for (const InnerSample& place : places) hole.extend(place.position);
  Findings findings(views, path, hole);
  for (const InnerSample& place : places) {
    findings.add(place, tolerance);
    if (after_place) after_place();
  }
  return findings.cause();
}

double tolerance_of(const LoopMeasures& loop) {
  return 2 * loop.perimeter / static_cast<double>(loop.points);
}

namespace {

// Takes at most so many points of the sample, evenly.
std::optional<Upward> upward_in_sample(const Detection& detection) {
  constexpr std::uint64_t kMost = 100'000;
  const std::uint64_t step = detection.sampled_points / kMost + 1;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
  std::uint64_t i = 0;
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    if (i++ % step != 0 || std::isnan(point.normal[0])) return;
    points.push_back(point.position());
    normals.emplace_back(point.normal[0], point.normal[1], point.normal[2]);
  });
  return other_upward(points, normals, detection.summary.surface_area);
}

}  // namespace

void find_causes(StationViews& stations, const RunConfig& run, ExplainedDetection& detection) {
  const TaskArena arena(static_cast<std::size_t>(run.threads));
  const std::span<const StationView> views = stations.complete(arena);
  const PathView* const path = stations.path();
  detection.stations = stations.summaries();
  detection.points_of_none = stations.points_of_none();
  if (!detection.stations.empty()) detection.upward = upward_in_sample(detection);
  detection.causes.assign(detection.loops.size(), {});
  arena.for_each(detection.loops.size(), [&](std::size_t i) {
    const LoopMeasures& loop = detection.loops[i];
    if (loop.kind != LoopKind::kHole || detection.stations.empty()) return;
    const std::vector<InnerSample> places = inside_places(detection, i);
    LoopCause& cause = detection.causes[i];
    const auto note = [&] { stations.note_touched(kPagesAround * detection.stations.size()); };
    cause = cause_of(places, views, path, tolerance_of(loop), note);
    if (!cause.main())
      cause = cause_of(places, views, path, 0, note);  // a coarse loop near all of the surface
  });
}

}  // namespace lacuna::io
