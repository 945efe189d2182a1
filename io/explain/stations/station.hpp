// SPDX-License-Identifier: Apache-2.0
// Stations: the places of scanners, and the points that each of them measured.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

struct Station {
  std::string name;
  Eigen::Vector3d place{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};    // unit: the scanner turns around it
  std::optional<std::size_t> file;  // index of the file with its points; empty: any file
  std::optional<std::uint32_t>
      source;  // its number in the column `scan` or `point_source_id`; empty: all rows
};

// Reads the stations that the user states, one on each line: a name without blanks, x y z, and its points.
// The points are a file name, a number in the column `scan` or `point_source_id`, or both in this order. A
// single station needs neither, and no name. Blanks, commas or semicolons divide the fields; lines that begin
// with # are comments. A first line without numbers is a header. File names are names in `files`, or the ends
// of such names. `layouts` are those of the files. Throws `Error`, also where a station has a number and no
// file of it has such a column.
std::vector<Station> read_stations(const std::filesystem::path& list,
                                   std::span<const std::filesystem::path> files,
                                   std::span<const RowLayout> layouts);

// Returns the value of each row in the column `scan` or `point_source_id`; empty if the layout has neither.
std::vector<double> sources_of(const RowBatch& rows, const RowLayout& layout);

}  // namespace lacuna::io
