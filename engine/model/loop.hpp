// SPDX-License-Identifier: Apache-2.0
// Loops: what the method returns for each hole.
#pragma once

#include "engine/model/points.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// A point on a loop, with all that is needed to measure and to draw it.
struct LoopPoint : ScanPoint {
  std::array<float, 3> surface{};  // mu_p - p: from the point towards where its neighbours are
  float probability = 0;
};

// A loop is written from its smallest id towards the smaller neighbour of that point. It is closed, and its
// first point is not repeated.
using Loop = std::vector<LoopPoint>;

enum class LoopKind : std::uint8_t {
  kHole,   // the surface lies outside of the loop
  kOuter,  // the surface lies inside: the outer edge of an open surface
};
constexpr const char* name_of(LoopKind kind) {
  return kind == LoopKind::kHole ? "hole" : "outer";
}

// What lies over an outer curve and beyond it, as shares in [0, 1] (method.md, D.3). 0: not measured.
struct BeyondCurve {
  double goes_on = 0;  // of its points: the surface goes on beyond, at their height
  double layers = 0;   // of its points, if the curve is a slice of quantised depth: beyond is the next slice
  double volume = 0;   // of the points over it: far from its plane, as in crowns of trees
};

// What confidence is computed from (method.md, D.3). The method "paper" measures none of it.
struct LoopEvidence {
  // The curve (method.md, C.6).
  double clearness = 1;     // how much empty circles along the loop exceed those around it, [0, 1]
  double surface = 1;       // how much the neighbourhoods along it resemble a surface, [0, 1]
  double spacing = 0;       // of the points along it; a length
  double sampling_gap = 0;  // radius of empty circles of the sampling over the distance to the neighbours
  bool is_coarse = false;   // found within the coarse bound
  // The loop among the points of its level.
  LoopKind kind = LoopKind::kHole;
  double width = 0;  // 2 area / perimeter, in spacings
  double compactness =
      0;  // width over the number of points: about 1/6 for a circle, 0 for a line there and back
  std::array<double, 3> middle{};  // of an outer curve: the centroid of its points
  double radius = 0;               // of its farthest point from there
  double prominence = 0;           // of a hole over the gaps around it; 0: not measured
  BeyondCurve beyond = {};
  // The track.
  double persistence = 0;   // octaves from the spacing to the last scale, 0 or more
  std::uint64_t alike = 0;  // of an outer curve: others of its size around it that stand; 0: not counted

  // Returns whether the loop is hardly wider than the gaps between points.
  static constexpr double kSmallWidth = 3;
  bool is_small() const { return width > 0 && width < kSmallWidth; }
  // Returns whether the loop may be reported. Other loops are gaps of the sampling.
  bool may_be_hole() const {
    constexpr double kLeastClearness = 0.5, kLeastSurface = 0.3;
    return clearness >= kLeastClearness && surface >= kLeastSurface;
  }
};

// How sure a loop is, and the levels at which it is found. Lengths are in units of the scan.
struct LoopTrack {
  double confidence = 1;  // that it is true, [0, 1]; 1 by the method "paper"
  LoopEvidence evidence = {};
  // Edges of the first and of the last lattice at which it is found; 0: among all points.
  double first_scale = 0, last_scale = 0;
};

// Values by which a user sorts and filters loops. Lengths are in units of the scan.
struct LoopMeasures {
  LoopKind kind = LoopKind::kHole;
  std::uint64_t points = 0;
  double perimeter = 0;  // sum of its edges' lengths
  double area = 0;       // of the loop projected along its normal; of a hole: without its islands
  double own_area = 0;   // of a reported hole: the part of its area that is in no larger one
  double diameter = 0;   // largest distance between two of its points
  Eigen::Vector3d centroid{0, 0, 0};  // of its points
  // Unit; its largest component is positive; 0 where the loop encloses nothing.
  Eigen::Vector3d normal{0, 0, 0};
  double planarity = 0;  // 1: in one plane; 1 - (thickness / extent) of its points, [0, 1]
  double mean_probability = 0;
  LoopTrack track;
  std::uint64_t tiles = 0;  // blocks of the reference lattice that it passes through
  // The loop of the other kind that it is an inner ring of (engine/loops/nest_loops.hpp), as an index; -1
  // without one. An island is an outer curve whose parent is a hole.
  std::int64_t parent = -1;
};

}  // namespace lacuna
