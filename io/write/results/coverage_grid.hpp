// SPDX-License-Identifier: Apache-2.0
// The coverage of a scan, in square cells viewed from above.
#pragma once

#include "engine/model/detection.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Cells by row from north to south, each from west to east.
struct CoverageGrid {
  Eigen::Vector2d corner{0, 0};  // of the scan's bounds without strays: west, north; whole cells from 0 0
  double edge = 0;               // of a cell, in units of the scan
  std::size_t columns = 0, rows = 0;
  std::vector<float> points;  // that take part, copies too
  std::vector<float> holes;   // share of the cell within holes in the plan, [0, 1]

  std::size_t size() const { return columns * rows; }
};

// Reads every file once more. Holes on walls cover nothing from above, and islands
// are no part of their hole. If holes overlap, their sum counts, up
// to 1. Throws `Error` if there would be more cells than the memory limit has space for. Memory: 8 bytes a
// cell. Cost: linear in points, and in the cells that holes cross.
CoverageGrid cover(const Detection& detection, const ScanFiles& scan, const FilesConfig& config);

// Adds the share of each cell within a closed polygon, without its inner rings. Rows are cut into eight
// strips, and each strip's share is exact along its middle.
using Ring2 = std::vector<Eigen::Vector2d>;
void add_polygon(const std::vector<Ring2>& rings, CoverageGrid& grid);

}  // namespace lacuna::io
