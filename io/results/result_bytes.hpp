// SPDX-License-Identifier: Apache-2.0
// The disk space that the results of a run take.
#pragma once

#include "io/options/options.hpp"
#include "io/scan/file_scan.hpp"

#include <cstdint>

#include <Eigen/Geometry>

namespace lacuna::io {

struct ResultBytes {
  std::uint64_t points = 0;  // the annotated scan; 0 if it is not wanted
  std::uint64_t sample = 0;  // sample.ply
  std::uint64_t report = 0;  // report.html without its loops
  std::uint64_t raster = 0;  // coverage.tif, at most: it is compressed

  std::uint64_t certain = 0;  // of `points`: the files whose rows have a fixed size

  std::uint64_t all() const { return points + sample + report + raster; }
};

// Returns the bytes for a scan with so many rows, of which so many points are evaluated. `bounds` are the
// scan's bounds without strays; if they are not known, the raster is left out. The files of loops and of
// boundary points and lids are left out, because they depend on the holes that are found.
ResultBytes result_bytes(const FileScan& scan, const FilesConfig& config, std::uint64_t rows,
                         std::uint64_t points, const Eigen::AlignedBox3d& bounds = {});

}  // namespace lacuna::io
