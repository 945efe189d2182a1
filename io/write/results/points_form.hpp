// SPDX-License-Identifier: Apache-2.0
// The points of files of a scan as a format has them: they become a file.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/write/results/annotated_rows.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lacuna::io {

// The input of the forms. The scan must outlive them.
struct PointsPlan {
  const ScanFiles& scan;
  const OutputConfig& config;
  IndexRange files;                   // of the scan: their rows become the file
  std::vector<ResultColumn> results;  // written behind each row
  LocalOffset offset;                 // of PLY
  std::string name;                   // of the file, for errors
};

// A form of rows: all columns of the input except the ones that the results replace.
class PointsForm {
 public:
  virtual ~PointsForm() = default;
  virtual std::size_t row_bytes() const = 0;  // without results
  // Reads all rows, from the first one on. Throws `Error`.
  virtual std::unique_ptr<InputRows> open() const = 0;
  // Begins a file of so many rows, each with its results behind it. `out` must outlive the writer. Throws
  // `Error`.
  virtual std::unique_ptr<RowsWriter> writer(OutputFile& out, std::uint64_t rows) const = 0;
};

// PLY, binary little endian. Properties have the names of the input.
std::unique_ptr<PointsForm> ply_form(const PointsPlan& plan);

// CSV: a header line and a line for each row, divided by commas. Each number is the shortest text that reads
// back as the same value of its type; a value that is not a number is `nan`.
std::unique_ptr<PointsForm> csv_form(const PointsPlan& plan);

// LAS 1.4 and LAZ (io/read/las/las_writer.hpp) of one LAS or LAZ file without a pose. Results are extra bytes:
// probability, angle and so on. Throws `Error` where the format cannot hold the points with their results.
// Reads the header alone.
std::unique_ptr<PointsForm> las_form(const PointsPlan& plan);
bool is_compressed_las(const std::filesystem::path& file);

}  // namespace lacuna::io
