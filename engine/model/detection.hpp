// SPDX-License-Identifier: Apache-2.0
// What a finished run hands to the writers: numbers in memory, everything of the scan's size as streams
// from the temporary folder.
#pragma once

#include "engine/model/loop.hpp"
#include "engine/run/progress.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

struct Counts {
  std::uint64_t points = 0;           // input rows
  std::uint64_t dropped = 0;          // with a non-finite coordinate
  std::uint64_t thinned_out = 0;      // represented by another point of their cell; 0 without a resolution
  std::uint64_t duplicates = 0;       // at the coordinates of a point with a lower id
  std::uint64_t candidates = 0;       // distinct points with Pi above the threshold
  std::uint64_t coherent = 0;         // those candidates that are coherent (paper, 5.1)
  std::uint64_t boundary_points = 0;  // points of the input: duplicates count, thinned-out ones do not
  std::uint64_t boundary_edges = 0;   // of the boundary graph; by the paper: eligible ones
  std::uint64_t components = 0;       // of the boundary graph
  std::uint64_t raw_loops = 0;        // of all levels, before tracking chooses
  std::uint64_t undefined_normals = 0;
  std::uint64_t normals_off = 0;  // given ones, by more than 45 degrees from the estimated ones
};

// A level of the scan.
struct LevelSummary {
  double edge = 0;           // of its lattice; 0: every point
  std::uint64_t points = 0;  // distinct ones
  std::uint64_t loops = 0;   // before tracking chooses
};

// Bins of equal width from 0 to 1.
inline constexpr std::size_t kProbabilityBins = 20;
using ProbabilityBins = std::array<std::uint64_t, kProbabilityBins>;

// Points far from all others (engine/bucket/strays.hpp has the rule), and where the others are. Views,
// printed digits and the report's positions follow `rest`, so a stray spoils none of them.
struct Strays {
  std::uint64_t points = 0;                           // distinct ones
  Eigen::Vector3d example = Eigen::Vector3d::Zero();  // the one of the lowest id
  bool has_origin = false;                            // one lies at 0 0 0
  Eigen::AlignedBox3d rest;                           // bounds of the others; empty without any
};

struct Summary {
  Counts counts;
  ProbabilityBins probabilities{};  // distinct points by their boundary probability
  Eigen::AlignedBox3d bounds;       // of the finite points; empty without any
  Strays strays;                    // without any, `rest` is `bounds`
  double resolution = 0;            // of the first level; 0: every point
  double mean_neighbours = 0;       // K
  double mean_edge_length = 0;      // over the edges of G
  double median_distance = 0;       // median over points of the mean distance to their neighbours; within 1 %
  double surface_area = 0;          // sampled; the median over levels of their estimates
  double hole_area = 0;             // of the reported holes, each place once
  double eps = 0;                   // in effect
  std::int64_t e = 0;               // in effect; 0: method tangential
  std::uint64_t tiles = 0;
  std::uint64_t tile_points = 0;     // in effect
  std::uint64_t threads = 0;         // in effect
  std::uint64_t memory_limit = 0;    // bytes, in effect
  std::vector<LevelSummary> levels;  // from fine to coarse
  std::vector<PhaseTime> phases;
};

inline constexpr std::size_t kMostCriteria = 8;

// The result of one point of the input. A duplicate has the result of the point that it copies. A point that
// was thinned out has the result of its representative.
struct PointResult {
  float probability;                          // from 0 to 1; NaN for a dropped point
  std::array<float, kMostCriteria> criteria;  // [0, 1]; as many as there are, in the order of the table
  // The point is on a loop, or it is a candidate that the method adds. The method `paper` adds coherent
  // candidates; `tangential` adds candidates between two neighbours on a loop.
  std::uint8_t boundary = 0;
  // The point is a candidate that coherence leaves (paper, 5.1), whichever method finds the loops.
  std::uint8_t coherent = 0;
  std::int32_t loop = -1;       // index of the first reported loop through it; -1: no loop
  std::array<float, 3> normal;  // NaN where undefined
};

struct BoundaryPoint : ScanPoint {
  float probability = 0;
  std::int32_t loop = -1;
};

// A point of the sample.
struct SampledPoint : ScanPoint {
  float probability = 0;
  std::array<float, 3> normal{};  // unit, unoriented; NaN where undefined
};

// A loop whose parent is a reported one (LoopMeasures::parent).
struct InnerRing {
  std::size_t loop = 0;  // for Detection::for_each_loop_point
  std::uint64_t points = 0;

  friend bool operator==(const InnerRing&, const InnerRing&) = default;
};

// A reported loop: selected, in order of (first id, length, ids).
struct ReportedLoop {
  LoopMeasures measures;
  Loop points;
};

// Calls visit with each element, in the stated order. It may be called as often as wanted.
template <class... Element>
using Stream = std::function<void(const std::function<void(Element...)>& visit)>;

// Streams are read from disk: they throw `Error`. Visits come from the calling thread.
struct Detection {
  Summary summary;
  std::vector<LoopMeasures> loops;  // reported ones, in order
  // The points of one of these loops, in its order. It may be larger than memory.
  std::function<void(std::size_t loop, const std::function<void(const LoopPoint&)>& visit)>
      for_each_loop_point;
  // Each reported loop has a row here, or there are no rows. Islands that the selection leaves out are in
  // them, too. Their numbers follow the numbers of the reported loops.
  std::vector<std::vector<InnerRing>> inner_rings;
  Stream<const BoundaryPoint&> for_each_boundary_point;  // in ascending id
  // Blocks of consecutive points of the input, in ascending id, bounded in size; only with results.points.
  Stream<PointId, std::span<const PointResult>> for_each_result_block;
  // In ascending id, spread evenly over the surface: at most results.sample_points, none without it.
  std::uint64_t sampled_points = 0;
  Stream<const SampledPoint&> for_each_sampled_point = [](const auto&) {};

  // Returns the inner rings of a loop, in order.
  std::span<const InnerRing> inner_rings_of(std::size_t loop) const {
    return loop < inner_rings.size() ? std::span<const InnerRing>(inner_rings[loop])
                                     : std::span<const InnerRing>();
  }
  // Reads the points of a loop or of an inner ring.
  Loop read_points(std::size_t loop) const {
    Loop points;
    for_each_loop_point(loop, [&](const LoopPoint& p) { points.push_back(p); });
    return points;
  }
  ReportedLoop read_loop(std::size_t loop) const { return {loops[loop], read_points(loop)}; }
};

}  // namespace lacuna
