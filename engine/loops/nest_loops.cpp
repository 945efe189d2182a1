// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/nest_loops.hpp"

#include "engine/loops/loop_plane.hpp"
#include "engine/store/scratch.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

// Loops by their centroids. Sorts them along the axis on which they extend the farthest. The loops must
// outlive it.
class Centroids {
 public:
  explicit Centroids(const std::vector<LoopMeasures>& loops) : loops_(loops), order_(loops.size()) {
    Eigen::AlignedBox3d box;
    for (const LoopMeasures& loop : loops) box.extend(loop.centroid);
    if (!loops.empty()) box.sizes().maxCoeff(&axis_);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(along(a), a) < std::pair(along(b), b); });
  }

  // Calls visit(loop) for each loop whose centroid is within `radius` of the place.
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& place, double radius, Visit&& visit) const {
    auto next = std::lower_bound(order_.begin(), order_.end(), place[axis_] - radius,
                                 [&](std::size_t loop, double least) { return along(loop) < least; });
    for (; next != order_.end() && along(*next) <= place[axis_] + radius; ++next) {
      if ((loops_[*next].centroid - place).norm() <= radius) visit(*next);
    }
  }

 private:
  double along(std::size_t loop) const { return loops_[loop].centroid[axis_]; }

  const std::vector<LoopMeasures>& loops_;
  std::vector<std::size_t> order_;
  Eigen::Index axis_ = 0;
};

// ---- Which loops are inside others

constexpr std::size_t kSamples = 32;  // points of a loop, or all if it has fewer

struct LoopSample {
  std::array<double, 3> point;
};

std::size_t sample_count(const LoopMeasures& loop) {
  return std::min<std::size_t>(kSamples, loop.points);
}

// Returns points at even steps along each loop: kSamples places for each.
std::span<LoopSample> sample_loops(const MeasuredLoops& loops, const Spill& spill, const Workers& workers,
                                   Scratch& scratch) {
  const std::span<LoopSample> samples = scratch.array<LoopSample>(kSamples * loops.measures.size());
  for_each_loop(loops.loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch&) {
    const std::size_t count = sample_count(loops.measures[i]);
    for (std::size_t s = 0; s < count; ++s) {
      const ScanPoint& p = loop[s * loop.size() / count];
      samples[kSamples * i + s] = {{p.x, p.y, p.z}};
    }
  });
  return samples;
}

// A sample of a loop that may be inside another one, in the other one's plane.
struct Inside {
  Eigen::Vector3d at;
  std::size_t loop;
  bool is_inside = false;
  // The nearest edge lies on the line through `at` along the first axis.
  double distance = std::numeric_limits<double>::infinity(), height = 0;  // of this edge

  bool is_near() const { return std::abs(at.z() - height) <= distance; }
};

// Passes the edges of the polygon. Each edge finds the samples on whose lines it is.
void compare_edges(const ChosenLoops& loops, std::size_t polygon, const LoopPlane& plane,
                   std::vector<Inside>& samples) {
  std::sort(samples.begin(), samples.end(),
            [](const Inside& a, const Inside& b) { return a.at.y() < b.at.y(); });
  const auto below = [](const Inside& sample, double y) { return sample.at.y() < y; };
  const auto compare = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const auto [low, high] = std::minmax(a.y(), b.y());
    auto sample = std::lower_bound(samples.begin(), samples.end(), low, below);
    for (; sample != samples.end() && sample->at.y() < high; ++sample) {
      const double along = (sample->at.y() - a.y()) / (b.y() - a.y());
      const double x = a.x() + along * (b.x() - a.x()), height = a.z() + along * (b.z() - a.z());
      if (x > sample->at.x()) sample->is_inside = !sample->is_inside;
      const double distance = std::abs(x - sample->at.x());
      if (std::tuple(distance, height) < std::tuple(sample->distance, sample->height)) {
        sample->distance = distance;
        sample->height = height;
      }
    }
  };
  std::optional<Eigen::Vector3d> first, before;
  loops.for_each_point(polygon, [&](const LoopPoint& p) {
    const Eigen::Vector3d at = plane(p.position());
    if (before) compare(*before, at);
    if (!first) first = at;
    before = at;
  });
  if (first) compare(*before, *first);
}

bool may_be_around(const LoopMeasures& loop, const LoopMeasures& other) {
  constexpr double kLeastCosine = 0.5;
  return loop.area > other.area && std::abs(loop.normal.dot(other.normal)) >= kLeastCosine;
}

// A loop inside another one.
struct Nested {
  std::size_t loop;
  double height;  // of its samples over the nearest edge, up or down: the mean
};

// Returns the loops of `others` that are inside the polygon.
std::vector<Nested> loops_inside(const MeasuredLoops& loops, std::size_t polygon,
                                 std::span<const std::size_t> others, std::span<const LoopSample> samples) {
  const LoopPlane plane = plane_of(loops.measures[polygon]);
  std::vector<Inside> inside;
  for (const std::size_t loop : others) {
    for (const LoopSample& sample : samples.subspan(kSamples * loop, sample_count(loops.measures[loop])))
      inside.push_back({plane(Eigen::Vector3d(sample.point[0], sample.point[1], sample.point[2])), loop});
  }
  compare_edges(loops.loops, polygon, plane, inside);
  std::erase_if(inside, [](const Inside& sample) { return !sample.is_inside || !sample.is_near(); });
  std::ranges::sort(inside, {}, [](const Inside& s) { return std::tuple(s.loop, s.at.y(), s.at.x()); });
  constexpr double kLeastFraction = 0.9;
  std::vector<Nested> most;
  for (auto first = inside.begin(); first != inside.end();) {
    const std::size_t loop = first->loop;
    double count = 0, heights = 0;
    for (; first != inside.end() && first->loop == loop; ++first, ++count)
      heights += std::abs(first->at.z() - first->height);
    if (count >= kLeastFraction * static_cast<double>(sample_count(loops.measures[loop])))
      most.push_back({loop, heights / count});
  }
  return most;
}

// Returns for each loop the smallest loop around it; -1 without one. Another sheet's loop may be smaller: a
// larger one counts where it is half as far up or down.
std::vector<std::int64_t> find_around(const MeasuredLoops& loops, const Spill& spill,
                                      const Workers& workers) {
  const std::vector<LoopMeasures>& measures = loops.measures;
  const MemoryLedger::Lease sampling = workers.memory.ledger.take(workers.memory.work / 4);
  Scratch scratch(spill.folder, sampling.bytes());
  const std::span<const LoopSample> samples = sample_loops(loops, spill, workers, scratch);
  const MemoryLedger::Lease comparing = workers.memory.ledger.take(workers.memory.work / 4);
  const std::size_t most = std::max<std::size_t>(1, comparing.bytes() / (kSamples * sizeof(Inside)));
  const Centroids centroids(measures);
  std::vector<std::size_t> by_area(measures.size());
  std::iota(by_area.begin(), by_area.end(), std::size_t{0});
  std::sort(by_area.begin(), by_area.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(measures[a].area, a) < std::pair(measures[b].area, b);
  });
  std::vector<std::int64_t> around(measures.size(), -1);
  std::vector<double> heights(measures.size(), std::numeric_limits<double>::infinity());
  const auto is_of_its_sheet = [&](std::size_t loop) {
    constexpr double kMostSpacings = 2;
    const double spacing = measures[loop].perimeter / static_cast<double>(measures[loop].points);
    return heights[loop] <= kMostSpacings * spacing;
  };
  std::vector<std::size_t> others;
  for (const std::size_t polygon : by_area) {
    const auto compare = [&] {
      if (others.empty()) return;
      for (const auto& [inner, height] : loops_inside(loops, polygon, others, samples)) {
        if (!(height < heights[inner] / 2)) continue;
        around[inner] = static_cast<std::int64_t>(polygon);
        heights[inner] = height;
      }
      others.clear();
      scratch.trim();
    };
    const LoopMeasures& loop = measures[polygon];
    centroids.for_each_near(loop.centroid, loop.diameter, [&](std::size_t other) {
      if (is_of_its_sheet(other) || !may_be_around(loop, measures[other])) return;
      others.push_back(other);
      if (others.size() == most) compare();
    });
    compare();
  }
  return around;
}

}  // namespace

void nest_loops(MeasuredLoops& loops, const Spill& spill, const Workers& workers, Phases& phases) {
  std::vector<LoopMeasures>& measures = loops.measures;
  Phase phase(phases, "nest", 0);
  const std::vector<std::int64_t> around = find_around(loops, spill, workers);
  std::vector<double> islands(measures.size(), 0.0);
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (around[i] < 0) continue;
    const auto parent = static_cast<std::size_t>(around[i]);
    if (measures[parent].kind == measures[i].kind) continue;
    measures[i].parent = around[i];
    if (measures[i].kind == LoopKind::kOuter)
      islands[parent] += measures[i].area * std::abs(measures[i].normal.dot(measures[parent].normal));
  }
  for (std::size_t i = 0; i < measures.size(); ++i)
    measures[i].area = std::max(0.0, measures[i].area - islands[i]);
}

NestedReport report_nested(const std::vector<LoopMeasures>& found, std::vector<std::size_t> selected) {
  std::vector<std::int64_t> place_of(found.size(), -1);
  for (std::size_t i = 0; i < selected.size(); ++i) place_of[selected[i]] = static_cast<std::int64_t>(i);
  const auto parent_of = [&](const LoopMeasures& loop) {
    return loop.parent < 0 ? -1 : place_of[static_cast<std::size_t>(loop.parent)];
  };
  NestedReport report;
  for (const std::size_t loop : selected) {
    report.loops.push_back(found[loop]);
    report.loops.back().parent = parent_of(found[loop]);
  }
  report.inner_rings.resize(selected.size());
  report.found = std::move(selected);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::int64_t parent = parent_of(found[i]);
    const bool is_left_out = place_of[i] < 0;
    if (parent < 0 || (is_left_out && found[i].kind == LoopKind::kHole)) continue;
    const std::size_t number = is_left_out ? report.found.size() : static_cast<std::size_t>(place_of[i]);
    if (is_left_out) report.found.push_back(i);
    report.inner_rings[static_cast<std::size_t>(parent)].push_back({number, found[i].points});
  }
  return report;
}

// ---- How much surface is missing

namespace {

constexpr std::size_t kPlaces = 32;  // of a hole

// A place of a hole.
struct Place {
  std::array<double, 3> at;
  std::uint8_t is_within, is_shared;
};

// The selected holes that enclose an area.
struct Holes {
  const ChosenLoops& loops;
  std::vector<std::size_t> chosen = {};     // among the loops
  std::vector<LoopMeasures> measures = {};  // of each

  std::size_t size() const { return chosen.size(); }
  std::uint64_t count(std::size_t i) const { return loops.count(chosen[i]); }
  void read(std::size_t i, std::span<LoopPoint> to) const { loops.read(chosen[i], to); }
};

Holes holes_of(const MeasuredLoops& loops, std::span<const std::size_t> selected) {
  Holes holes{.loops = loops.loops};
  for (const std::size_t i : selected) {
    const LoopMeasures& loop = loops.measures[i];
    if (loop.kind != LoopKind::kHole || !(loop.area > 0) || !std::isfinite(loop.area)) continue;
    holes.chosen.push_back(i);
    holes.measures.push_back(loop);
  }
  return holes;
}

using Polygon = std::span<const std::array<double, 2>>;

Polygon polygon_of(std::span<const LoopPoint> loop, const LoopPlane& plane, Scratch& scratch) {
  const std::span<std::array<double, 2>> polygon = scratch.array<std::array<double, 2>>(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d at = plane(loop[i].position());
    polygon[i] = {at.x(), at.y()};
  }
  return polygon;
}

}  // namespace

double measure_hole_area(MeasuredLoops& loops, std::span<const std::size_t> selected, const Spill& spill,
                         const Workers& workers) {
  const Holes holes = holes_of(loops, selected);
  const std::vector<LoopMeasures>& measures = holes.measures;
  const MemoryLedger::Lease placing = workers.memory.ledger.take(workers.memory.work / 4);
  Scratch scratch(spill.folder, placing.bytes());
  const std::span<Place> places = scratch.array<Place>(kPlaces * holes.size());
  for_each_loop(holes, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& own) {
    const LoopPlane plane = plane_of(measures[i]);
    std::size_t next = kPlaces * i;
    for (const Eigen::Vector2d& place : places_within(polygon_of(loop, plane, own), kPlaces)) {
      const Eigen::Vector3d at = plane.point_at({place.x(), place.y(), 0});
      places[next++] = {{at.x(), at.y(), at.z()}, 1, 0};
    }
  });

  const Centroids centroids(measures);
  for_each_loop(holes, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& own) {
    constexpr double kLeastCosine = 0.5, kNear = 0.25;
    const LoopMeasures& larger = measures[i];
    const LoopPlane plane = plane_of(larger);
    Polygon polygon;
    centroids.for_each_near(larger.centroid, larger.diameter, [&](std::size_t other) {
      const LoopMeasures& hole = measures[other];
      if (std::tie(hole.area, other) >= std::tie(larger.area, i)) return;
      if (std::abs(hole.normal.dot(larger.normal)) < kLeastCosine) return;
      if (polygon.empty()) polygon = polygon_of(loop, plane, own);
      for (Place& place : places.subspan(kPlaces * other, kPlaces)) {
        if (place.is_within == 0) break;
        const Eigen::Vector3d at = plane(Eigen::Vector3d(place.at[0], place.at[1], place.at[2]));
        if (std::abs(at.z()) <= kNear * std::sqrt(hole.area) && is_inside(polygon, at.head<2>()))
          std::atomic_ref(place.is_shared).store(1, std::memory_order_relaxed);
      }
    });
  });

  double area = 0;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    int within = 0, shared = 0;
    for (const Place& place : places.subspan(kPlaces * i, kPlaces)) {
      within += place.is_within;
      shared += place.is_shared;
    }
    double& own = loops.measures[holes.chosen[i]].own_area;
    own = within > 0 ? measures[i].area * (within - shared) / within : measures[i].area;
    area += own;
  }
  return area;
}

}  // namespace lacuna
