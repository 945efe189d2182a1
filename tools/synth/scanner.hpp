// A virtual terrestrial laser scanner.
#pragma once

#include "io/output_set.hpp"
#include "tools/synth/permutation.hpp"
#include "tools/synth/ply_output.hpp"
#include "tools/synth/scene.hpp"

#include <array>
#include <cstdint>
#include <filesystem>

namespace lacuna::synth {

struct ScanOptions {
  std::filesystem::path out;  // PLY
  SceneKind scene = SceneKind::kRoom;
  std::uint64_t points = 1'000'000;  // about: rays are chosen to return so many
  std::uint32_t stations = 2;        // [1, 255]
  double noise = 0.002;              // along the ray, metres, standard deviation
  double outliers = 0;               // fraction of the points that lie anywhere on their ray instead, [0, 1]
  double max_range = 80;             // metres
  Order order = Order::kScanline;
  std::uint64_t seed = 1;
  std::array<double, 3> translate{0, 0, 0};  // metres
  Coordinates coordinates = Coordinates::kFloat;
  Overwrite overwrite = Overwrite::kOwn;
};

struct ScanSummary {
  std::uint64_t points = 0;
  std::uint64_t rays = 0;
};

// Writes what the stations see, station after station in upright scanlines (or all rays in random order): the
// nearest surface in each direction, so things cast shadows, and glass, black and grazed surfaces and the far
// distance return nothing. Each point has its station (`scan`) and an `intensity` in [0, 1]. Every point is a
// function of the seed and its ray alone; memory does not depend on their number.
ScanSummary write_scan(const ScanOptions& options);

}  // namespace lacuna::synth
