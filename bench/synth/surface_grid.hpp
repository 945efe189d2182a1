// SPDX-License-Identifier: Apache-2.0
// surface_grid: the grid that a surface is made of, which of its nodes exist, and where it ends. Also the
// smooth shapes that it is laid on.
//
// Idea: a surface is a plane of rows and columns, closed in no, one or both directions. Half of it may be
// thinned. A map from the plane to space makes a torus or a sphere of it.
#pragma once

#include "bench/synth/surface.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace lacuna::synth {

// A node of the grid is written row * columns + column. Columns beyond `step_column` are thinned to every
// `stride`-th, and so are the rows there.
struct SurfaceGrid {
  std::uint32_t rows = 0, columns = 0;
  bool wrap_rows = false, wrap_columns = false;  // the last row (column) is next to the first
  std::uint32_t step_column = 0;
  std::uint32_t stride = 1;
  // The columns belong to so many square panels side by side: the faces of a cube, which may be blown up to a
  // sphere. Panels are neighbours in space, not in the grid, and their nodes are the middles of the grid's
  // squares.
  std::uint32_t panels = 1;

  std::uint32_t panel_columns() const { return columns / panels; }
  std::uint64_t nodes() const { return std::uint64_t{rows} * columns; }
  std::uint64_t node(std::uint32_t row, std::uint32_t column) const {
    return std::uint64_t{row} * columns + column;
  }
  bool thinned(std::uint32_t column) const { return stride > 1 && column > step_column; }
  bool exists(std::uint32_t row, std::uint32_t column) const {
    return !thinned(column) || (row % stride == 0 && (column - step_column) % stride == 0);
  }
};

// A place between the nodes, in fractions of rows and columns.
struct GridPosition {
  double row = 0, column = 0;
};

// A closed curve in the plane of the grid; its parameter goes from 0 to 1.
struct Outline {
  double length = 0;  // nodes; an ellipse has a bound from above
  std::function<GridPosition(double)> at;
};

// Returns the root of a square, else the next whole number.
std::uint32_t root_of(std::uint32_t square);

// Returns a grid with about `options.points` nodes besides the nodes that the holes will take. Throws `Error`
// if that is too few or too many.
SurfaceGrid lay_grid(const SurfaceOptions& options);

// Returns the outer edges, each in the order of its nodes. A sheet has one outer edge, a tube two; a torus, a
// sphere and a cube have none. Where the density steps, fine and coarse quads join without a gap.
std::vector<NumberLoop> rims(const SurfaceGrid& grid);

// Returns the outer edges as curves.
std::vector<Outline> outer_edges(const SurfaceGrid& grid);

struct SurfacePoint {
  Vec3 position;
  Vec3 normal;  // unit
};

// Maps the plane of the grid to space. Neighbours are one spacing apart on average. A torus is denser inside,
// a sphere cap at its corners. A sphere is denser by up to 1.4 along the edges of its six panels, because of
// its geometry. A density factor applies to every panel.
class SurfaceShape {
 public:
  SurfaceShape(const SurfaceGrid& grid, const SurfaceOptions& options);

  // Returns the point at a place between the nodes, in rows and columns.
  SurfacePoint at(double row, double column) const;

 private:
  SurfacePoint on_panel(double row, double column) const;

  SurfaceGrid grid_;
  SurfaceKind kind_;
  double rows_, columns_;  // steps from the first to the last, or around
  double height_, width_;  // rows_ and columns_, units of the scan
  double stretch_;         // largest over smallest step in each direction
};

}  // namespace lacuna::synth
