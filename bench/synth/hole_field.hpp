// SPDX-License-Identifier: Apache-2.0
// The holes planted in a synthetic surface: which part of its grid they take, and their true loops.
#pragma once

#include "bench/synth/surface_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::synth {

// Holes are ellipses in the plane of the grid, at most one per cell of a coarse lattice and wholly inside it.
// So no hole comes near another one, the outer edge, a density step or the edge of a panel.
//
// On a jittered grid, the surface is the quads whose four nodes exist. A loop is the closed chain of edges
// with exactly one such quad. A hole has exactly one loop, which visits no node twice, because the nodes that
// it takes are those inside a convex curve. A line through a node next to it has one of the node's quads on
// its far side. So no node is left without a quad. If a node's only quads were two opposite ones, it would
// lie between two removed nodes, so inside.
class HoleField {
 public:
  // Throws `Error` when the holes do not fit.
  HoleField(const SurfaceGrid& grid, const SurfaceOptions& options);

  std::size_t size() const { return holes_.size(); }
  bool takes(double row, double column) const;

  // Returns the hole's edge.
  Outline outline(std::size_t hole) const;

  // Returns one loop per hole, each closed, in the order of its edges.
  std::vector<NumberLoop> loops() const;

 private:
  // The ellipse is a dx^2 + 2 b dx dy + c dy^2 <= 1, with dx along the columns.
  struct Ellipse {
    double row, column;
    double a, b, c;

    double form(double at_row, double at_column) const {
      const double dx = at_column - column;
      const double dy = at_row - row;
      return a * dx * dx + 2 * b * dx * dy + c * dy * dy;
    }
    bool takes(std::int64_t at_row, std::int64_t at_column) const {
      return form(static_cast<double>(at_row), static_cast<double>(at_column)) <= 1;
    }
    bool quad_is_whole(std::int64_t top, std::int64_t left) const {
      return !takes(top, left) && !takes(top, left + 1) && !takes(top + 1, left) && !takes(top + 1, left + 1);
    }
  };
  NumberLoop trace(const Ellipse& hole) const;

  SurfaceGrid grid_;
  std::uint32_t cell_rows_ = 1, cell_columns_ = 1;  // nodes per cell
  std::uint32_t down_ = 0, across_ = 0;             // cells, of one panel
  std::vector<Ellipse> holes_;
  std::vector<std::int32_t> hole_of_cell_;  // -1 if the cell has no hole
};

}  // namespace lacuna::synth
