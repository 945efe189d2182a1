// SPDX-License-Identifier: Apache-2.0
// surface: surfaces with holes whose true loops are known, of any size (`lacuna-bench synth surface`).
//
// Idea: holes are cut into the plane of a grid, which is laid on a smooth shape. The true loops are known in
// the plane. Cost: constant for a point; memory for the loops' points alone.
#pragma once

#include "bench/synth/made_files.hpp"

#include <array>
#include <cstdint>
#include <filesystem>

namespace lacuna::synth {

enum class PositionKind { kJittered, kRandom };
enum class SurfaceKind { kPlane, kWaves, kCylinder, kTorus, kSphereCap, kSphere, kCube };

struct SurfaceOptions {
  std::filesystem::path out;    // PLY
  std::filesystem::path truth;  // the true loops; empty means NAME.loops.txt next to `out`
  SurfaceKind kind = SurfaceKind::kPlane;
  std::uint64_t points = 1'000'000;          // about
  double spacing = 0.01;                     // mean distance of grid neighbours, units of the scan
  std::uint64_t holes = 8;                   // none touches another or the outer edge
  std::array<double, 2> hole_radius{4, 12};  // spacings, [1.5, ..), smallest and largest
  PositionKind positions = PositionKind::kJittered;
  double jitter = 0.25;            // of the local spacing, [0, 0.5]; not of random positions
  double noise = 0;                // along the normal, spacings, standard deviation
  std::uint32_t density_step = 1;  // 1, 4, 9, 16, ...: one half has 1/F of the density
  double density_factor = 1;       // [1, 100]: densest over sparsest, changing smoothly
  Order order = Order::kScanline;
  std::uint64_t seed = 1;
  std::array<double, 3> translate{0, 0, 0};  // units of the scan
  Coordinates coordinates = Coordinates::kFloat;
  io::Overwrite overwrite = io::Overwrite::kOwn;
};

// Writes the surface and the file of its true loops: a comment, then one loop per line, the 0-based ids of
// its points. Every point is a function of the seed and its number alone. So the order changes only ids, and
// memory grows with the loops, not with the points. Throws `Error` for options that make no surface and for
// files that cannot be written.
Made write_surface(const SurfaceOptions& options);

}  // namespace lacuna::synth
