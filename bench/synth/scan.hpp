// SPDX-License-Identifier: Apache-2.0
// scan: a scene as terrestrial or moving laser scanners sample it (`lacuna-bench synth scan`). A flight has a
// range and a field of view of its own.
//
// Idea: each ray of a scanner gives at most one point. A true loop has the points that are nearest to a place
// on the edge of what is sampled, as the place goes around. Cost: a ray takes a step for each shape of the
// scene.
#pragma once

#include "bench/synth/made_files.hpp"
#include "bench/synth/scene.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna::synth {

inline constexpr std::array<double, 2> kFieldOfView{-60, 90};

struct ScanOptions {
  std::filesystem::path out;    // PLY
  std::filesystem::path truth;  // the true loops; empty means NAME.loops.txt next to `out`
  SceneKind scene = SceneKind::kRoom;
  std::uint64_t points = 1'000'000;  // about: rays are chosen to return so many
  std::uint32_t stations = 2;        // [1, 255]; strips of a flight, lanes of a drive
  bool drives = false;               // along x, with profiles at right angles to its path
  std::vector<double> places;        // x y z of further stations
  double station_factor = 1;         // [0.01, 100]: points of the first station over points of each other one
  std::uint32_t sweeps = 1;          // [1, 8], of each station; several are tilted, so that they cross
  double noise = 0.002;              // along the ray, metres, standard deviation
  double outliers = 0;               // fraction of the points that lie anywhere on their ray instead, [0, 1]
  double registration = 0;           // of each station after the first, metres, standard deviation
  double max_range = 80;             // metres
  double ring_ratio = 1;             // [0.01, 100]: step of elevation over step of azimuth
  std::array<double, 2> field_of_view = kFieldOfView;  // lowest and highest elevation, degrees
  Order order = Order::kScanline;
  std::uint64_t seed = 1;
  std::array<double, 3> translate{0, 0, 0};  // metres
  Coordinates coordinates = Coordinates::kFloat;
  io::Overwrite overwrite = io::Overwrite::kOwn;
};

// Writes what the stations sample, station after station in upright scanlines (or all rays in random order).
// A station samples the nearest surface in each direction, so things cast shadows. Glass, black and grazed
// surfaces and the far distance return nothing. Each point has its station (`scan`) and an `intensity` in [0,
// 1]. Points of a moving scanner have a `gps_time`, too. OUT.stations.txt or OUT.trajectory.txt has the
// places of the scanner. Every point is a function of the seed and its ray alone; memory does not depend on
// their number.
//
// Another file has the true loops (ScanTruth in scan.cpp). A comment before each loop names it. Steps of
// density follow.
Made write_scan(const ScanOptions& options);

// Writes the scan of a given scene.
Made write_scan(const ScanOptions& options, const Scene& scene);

}  // namespace lacuna::synth
