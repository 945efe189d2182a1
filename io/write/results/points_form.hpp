// SPDX-License-Identifier: Apache-2.0
// The annotated scan as rows of bytes: the columns of each point in the input, then its results. And these
// rows as a format has them, so that they become a file.
#pragma once

#include "engine/model/detection.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

// A result: its name, its type and where a PointResult has it.
struct ResultColumn {
  std::string name;
  Scalar type;
  std::size_t offset;
};

// Returns scalar_probability, the criteria, scalar_boundary, scalar_coherent and scalar_loop; with
// config.points_normals also nx ny nz, unless a file of the scan has normals.
std::vector<ResultColumn> result_columns(const ScanFiles& scan, const OutputConfig& config);
// PLY files have `quality` directly behind scalar_loop, too: the probability for MeshLab.
inline constexpr std::string_view kQuality = "quality", kBeforeQuality = "scalar_loop";
bool is_earlier_quality(const RowLayout& layout, std::size_t index);
// Whether the results replace this property, because it has the name of a result. If scalar_loop is a result,
// the `quality` of an earlier run is replaced, too.
bool is_earlier_result(const RowLayout& layout, std::size_t index, std::span<const ResultColumn> results);
std::size_t bytes_of(std::span<const ResultColumn> results);  // packed

// Copies the results of rows to `out` and on, `stride` bytes apart, packed.
void copy_results(std::span<const PointResult> results, std::span<const ResultColumn> columns,
                  std::size_t stride, std::byte* out);

// Reads the rows of a scan's files once more, in order, in the form that a format needs.
class InputRows {
 public:
  virtual ~InputRows() = default;
  // Reads the next rows, at most `max_rows`, each to the beginning of `stride` bytes of `block`, which is
  // resized to them all. Returns their number; 0 at the end. Throws `Error`.
  virtual std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) = 0;
};

// Returns the union of the files' properties by name, in order of first appearance, packed. A property is
// double if types differ. It is NaN or 0 in the rows of a file that has no such property. `is_left_out`
// marks, by the index of a property, the ones that do not count.
using LeftOut = std::function<bool(const RowLayout& layout, std::size_t index)>;
RowLayout join_layouts(std::span<const RowLayout> layouts, const LeftOut& is_left_out);

// The joined rows of files. Positions are relative to the offset, if there is one: x y z are floats then.
class JoinedRows final : public InputRows {
 public:
  JoinedRows(const ScanFiles& scan, RowLayout joined, IndexRange files, const LocalOffset& offset);
  std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) override;

 private:
  void copy_columns(std::size_t stride, std::byte* out) const;

  const ScanFiles& scan_;
  RowLayout joined_;
  std::vector<const Property*> sources_;         // in the reader's layout, one for each column
  std::vector<std::optional<double>> summands_;  // of each column; empty if the column stays as it is
  std::size_t file_, end_;
  std::unique_ptr<ScanReader> reader_;
  RowBatch rows_;
};

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

// LAS 1.4 and LAZ (io/read/las/las_points.hpp) of one LAS or LAZ file without a pose. Results are extra
// bytes: probability, angle and so on. Throws `Error` where the format cannot hold the points with their
// results. Reads the header alone.
std::unique_ptr<PointsForm> las_form(const PointsPlan& plan);
bool is_compressed_las(const std::filesystem::path& file);

}  // namespace lacuna::io
