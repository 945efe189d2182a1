// SPDX-License-Identifier: Apache-2.0
// The points of a scan as a format has them. All of them, or any selection, become a file.
#pragma once

#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"
#include "io/local_offset.hpp"
#include "io/options/options.hpp"
#include "io/results/annotated_rows.hpp"
#include "io/results/output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {

// A file that is being written.
class PointsWriter {
 public:
  virtual ~PointsWriter() = default;
  // Whole rows of the form, each with its results behind it. Throws `Error`.
  virtual void put(std::span<const std::byte> rows) = 0;
  // Once, after all rows. Throws `Error`.
  virtual void finish() {}
};

// What a file holds: the points of the scan, or some of them.
enum class PointsPart : std::uint8_t { kAll, kSelection };

// All columns of the input but those that the results replace.
class PointsForm {
 public:
  virtual ~PointsForm() = default;
  virtual std::size_t row_bytes() const = 0;  // without results
  // All rows, from the first one on. Throws `Error`.
  virtual std::unique_ptr<InputRows> open() const = 0;
  // Begins a file of so many rows. LAS may get fewer. `out` must outlive the writer. Throws `Error`.
  virtual std::unique_ptr<PointsWriter> writer(OutputFile& out, std::uint64_t rows,
                                               PointsPart part) const = 0;
};

// What the forms are made of. The scan must outlive them.
struct PointsPlan {
  const FileScan& scan;
  const OutputConfig& config;
  std::vector<ResultColumn> results;
  LocalOffset offset;         // of PLY and PCD
  bool keeps_earlier = true;  // LAS: results of earlier runs stay
  std::string name;           // of the file, for errors
};

std::unique_ptr<PointsForm> ply_form(const PointsPlan& plan);
std::unique_ptr<PointsForm> pcd_form(const PointsPlan& plan);
std::unique_ptr<PointsForm> csv_form(const PointsPlan& plan);
// Reads files once where their coordinates need another scale, or are not LAS. Throws `Error`.
std::unique_ptr<PointsForm> las_form(const PointsPlan& plan);
std::unique_ptr<PointsForm> laz_form(const PointsPlan& plan);

// Throws `Error` where the form cannot be made, as far as headers show it.
void check_las_form(const PointsPlan& plan);
void check_laz_form(const PointsPlan& plan);

// Writes every row of the scan in order, each with its results, but those that the format cannot hold. Throws
// `Error`.
void write_annotated(const Detection& detection, const PointsForm& form,
                     std::span<const ResultColumn> results, OutputFile& out);

}  // namespace lacuna::io
