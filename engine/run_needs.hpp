// SPDX-License-Identifier: Apache-2.0
// What a run takes of the disk and of memory, from its size and its options.
#pragma once

#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/point_column.hpp"

#include <cstdint>

namespace lacuna {

struct RunSize {
  std::uint64_t rows = 0;    // of the input
  std::uint64_t points = 0;  // of the first level
  std::uint64_t tile_points = 0;
  double candidates = 0;  // share of the points that are, as on rough surfaces
  Precision precision = Precision::kSingle;
  bool is_thinned = false;
  bool has_levels = false;
  bool has_normals = false;
  bool reads_slowly = false;
};

// From the headers of the scan alone: every row counts, and none is thinned out unless the config has a
// resolution. Then, and where the number of rows is not known, there are no points.
RunSize size_from_headers(const PointSource& scan, const Job& job);

// Bytes of the workspace. Lists between tiles are those of surfaces; scans that are rough all over have up to
// twice as many.
struct DiskNeeds {
  std::uint64_t most = 0;  // at any time
  std::uint64_t last = 0;  // while the results are written
};
DiskNeeds disk_needs(const RunSize& size, const Job& job);

// Bytes that a scan which reads slowly certainly takes; 0 for others, whose points are counted first.
std::uint64_t kept_bytes(const RunSize& size);

// Bytes of the process while tiles are evaluated. Never above the memory limit.
std::uint64_t memory_needs(const RunSize& size, const Job& job);

}  // namespace lacuna
