// SPDX-License-Identifier: Apache-2.0
// The options of `lacuna-bench synth surface`.
#pragma once

#include "bench/synth/permutation.hpp"
#include "bench/synth/ply_output.hpp"
#include "io/read/files/output_file.hpp"

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

}  // namespace lacuna::synth
