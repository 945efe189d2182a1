// SPDX-License-Identifier: Apache-2.0
// The smooth surfaces that the grid is laid on.
#pragma once

#include "bench/synth/surface_grid.hpp"
#include "bench/synth/vec3.hpp"

namespace lacuna::synth {

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

  SurfaceKind kind_;
  bool wrap_rows_, wrap_columns_;
  std::uint32_t panels_;
  double rows_, columns_;  // steps from the first to the last, or around
  double height_, width_;  // rows_ and columns_, units of the scan
  double stretch_;         // largest over smallest step in each direction
};

}  // namespace lacuna::synth
