// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/hole_area.hpp"

#include "engine/loops/centroids.hpp"
#include "engine/loops/loop_plane.hpp"
#include "engine/loops/places_within.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {
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
