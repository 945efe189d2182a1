// SPDX-License-Identifier: Apache-2.0
// The method done plainly, in memory and in one piece: what every engine test compares against. It is written
// straight from docs/method.md, for the eye and not for speed. Sections 1 to 3 below are its part A, 4 to 6
// its part B, the stars its part C. It shares parameters and ids with the engine, but no code. Neighbours
// come from nanoflann. Ids are ranks in the input: `points[value(id)]`.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/ids.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace lacuna::reference {

// One point of the input. A duplicate has everything of the point that stands for it; a dropped point has
// nothing but its flag.
struct Point {
  bool dropped = false;      // a coordinate is not finite
  PointId representative{};  // lowest id at the same coordinates: its own, but for duplicates

  // 1. Neighbourhoods
  std::vector<PointId> neighbours;  // N_p by (squared distance, id)
  double mean_distance = 0;         // r_p; 0 without neighbours

  // 2. Normals. None where undefined.
  std::optional<Eigen::Vector3d> normal;           // as the criteria used it, of either sign
  std::optional<Eigen::Vector3d> oriented_normal;  // the same line; only with normals.orient
  bool is_top = false;                             // of its component: its normal says which way is up
  bool turned = false;                             // at a crease
  bool turned_by_rounding = false;                 // or not: the turn halves the angle probability exactly

  // 3. Criteria
  double angle = 1;
  double halfdisc = 1;
  double shape = 1;
  double combined = 1;                                   // before rounding
  double probability = 1;                                // Pi: a multiple of 2^-24
  std::optional<std::array<PointId, 2>> gap;             // the gap neighbours, nearer first; may be the same
  Eigen::Vector3d surface{0, 0, 0};                      // mu_p - p
  std::array<double, 3> lambda{1. / 3, 1. / 3, 1. / 3};  // Lambda_p, largest first
  double surface_share = 0;                              // of the boundary and the interior shape

  // 4 to 6.
  bool coherent = false;
  bool boundary = false;  // coherent or on a loop
};

struct Edge {
  PointId low{};
  PointId high{};
  double weight = 0;

  bool operator==(const Edge&) const = default;
};

struct Detection {
  std::vector<Point> points;       // one per row of the input
  std::vector<PointId> distinct;   // the points of the method, ascending
  double mean_neighbours = 0;      // K
  double mean_edge_length = 0;     // over the edges of G; 0 without edges
  double eps = 0;                  // in effect
  std::int64_t e = 0;              // in effect
  std::size_t boundary_edges = 0;  // of the boundary graph
  std::vector<Edge> eligible;      // with w_total, in the order in which they are taken
  std::vector<std::vector<PointId>>
      loops;  // of the paper raw, as step 6 writes and sorts them; else those that stand
  std::vector<double> confidences;  // of the loops; of the paper's all 1
};

// `normals` is empty or has one per point. Throws `Error` where the squared distance of distinct points is
// 0 or infinite. About O(n log n), and O(n) more for every edge that closes a loop and every loop.
Detection detect(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& normals,
                 const Config& config);

// By first id, then short ones first, then by all ids.
std::vector<std::vector<PointId>> in_report_order(std::vector<std::vector<PointId>> loops);

}  // namespace lacuna::reference
