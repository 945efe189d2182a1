// SPDX-License-Identifier: Apache-2.0
// A scene as terrestrial laser scanners sample it.
#pragma once

#include "bench/synth/scan_options.hpp"

#include <cstdint>
#include <filesystem>

namespace lacuna::synth {

struct ScanSummary {
  std::uint64_t points = 0;
  std::uint64_t rays = 0;
  std::uint64_t loops = 0;  // true ones
  std::filesystem::path truth;
};

// Writes what the stations sample, station after station in upright scanlines (or all rays in random order).
// A station samples the nearest surface in each direction, so things cast shadows. Glass, black and grazed
// surfaces and the far distance return nothing. Each point has its station (`scan`) and an `intensity` in [0,
// 1]. Points of a moving scanner have a `gps_time`, too. OUT.stations.txt or OUT.trajectory.txt has the
// places of the scanner. Every point is a function of the seed and its ray alone; memory does not depend on
// their number.
//
// Another file has the true loops (scan_truth.hpp). A comment before each loop names it. Steps of density
// follow.
ScanSummary write_scan(const ScanOptions& options);

// Writes the scan of a given scene.
ScanSummary write_scan(const ScanOptions& options, const Scene& scene);

}  // namespace lacuna::synth
