// SPDX-License-Identifier: Apache-2.0
// Independent points: a Poisson process in the plane of the grid, one point per node on average.
#pragma once

#include "bench/synth/positions.hpp"
#include "bench/synth/random.hpp"

namespace lacuna::synth {

// In a Poisson process the squares of the grid are independent of each other. Each has a Poisson number of
// points (mean 1), anywhere in the square. Points in a hole are left out. Beyond a density step, only one
// point in `stride` squared stays. A square has at most kMostInSquare points: more would come once in 1.6e10
// squares.
//
// The true loop of a hole is the sequence of points that are nearest to a place on its edge, as the place
// goes around. Distances are measured in the plane of the grid. Neighbours in that sequence share an edge of
// the Delaunay triangulation, and no point lies inside the loop. It encloses the hole, parts of its points'
// Voronoi cells, and empty discs around places on the edge. True loops of outer edges follow the surface's
// edge in the same way.
class RandomPositions : public Positions {
 public:
  static constexpr std::uint64_t kMostInSquare = 12;

  RandomPositions(const SurfaceGrid& grid, const HoleField& holes, const SurfaceOptions& options);

  std::uint64_t size() const override { return rows_ * columns_ * kMostInSquare; }
  std::optional<GridPosition> at(std::uint64_t number) const override;
  std::vector<NumberLoop> true_loops() const override;

 private:
  std::uint64_t points_in(std::uint64_t square) const;
  std::uint64_t nearest(GridPosition place) const;

  const SurfaceGrid& grid_;
  const HoleField& holes_;
  std::uint64_t rows_, columns_;  // of squares
  double corner_;                 // row and column of the first square
  Random count_, place_, kept_;
};

}  // namespace lacuna::synth
