// SPDX-License-Identifier: Apache-2.0
// Finds where the surfaces of a scene are sampled, on a lattice.
#pragma once

#include "bench/synth/patches.hpp"
#include "bench/synth/visibility.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::synth {

// The nodes of one patch. Nodes outside of it are valid arguments, and are not sampled.
struct Lattice {
  Patch patch;
  std::int32_t columns, rows;         // nodes, along u and v
  double step;                        // metres, the larger of both directions
  std::vector<float> spacing;         // of the points around each node; 0 if no station samples it
  std::vector<std::uint8_t> sampled;  // by a station, or in a gap too narrow for a hole
  std::vector<bool> by_station;       // is the node sampled: station after station of each node

  std::size_t node(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  bool inside(std::int32_t column, std::int32_t row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
  bool is_sampled(std::int32_t column, std::int32_t row) const {
    return inside(column, row) && sampled[node(column, row)] != 0;
  }
  double u(double column) const { return column / (columns - 1); }
  double v(double row) const { return row / (rows - 1); }
  // Places between the nodes are valid, too.
  ScenePoint at(double column, double row) const {
    return {patch.place(u(column), v(row)), patch.normal(u(column), v(row)), patch.shape, patch.two_sided};
  }
};

// The lattice has about 4 nodes per point, but at most 3 million, and fewer for more than 4 sweeps.
std::vector<Lattice> sample_surfaces(const Scanner& scanner, const Visibility& visibility,
                                     std::uint64_t points);

// A place that no station samples counts as sampled all the same unless it lies in a hole. Holes are balls
// with this radius, in spacings of the nearest sampled places, in which nothing is sampled. Every place
// within 1.5 radii of the middle of a ball belongs to its hole. Places on the far side of a thin thing are
// not near.
void close_gaps(std::vector<Lattice>& lattices, const Visibility& visibility, double hole_radius);

}  // namespace lacuna::synth
