// SPDX-License-Identifier: Apache-2.0
// The annotated scan as rows of bytes: what the input has of each point, then its results.
#pragma once

#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"
#include "io/local_offset.hpp"
#include "io/options/options.hpp"
#include "io/scan_reader.hpp"

#include <cstddef>
#include <functional>
#include <memory>
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

// scalar_probability, the criteria, scalar_boundary, scalar_coherent and scalar_loop; with config.normals
// also nx ny nz, unless a file of the scan has normals.
std::vector<ResultColumn> result_columns(const FileScan& scan, const OutputConfig& config);
// PLY files have `quality` directly behind scalar_loop, too: the probability for MeshLab.
inline constexpr std::string_view kQuality = "quality", kBeforeQuality = "scalar_loop";
bool is_earlier_quality(const RowLayout& layout, std::size_t index);
// Whether the results replace this property: it has the name of one. Where scalar_loop is one, the `quality`
// of an earlier run is replaced, too.
bool is_earlier_result(const RowLayout& layout, std::size_t index, std::span<const ResultColumn> results);
std::size_t bytes_of(std::span<const ResultColumn> results);  // packed

// The rows of all files of a scan once more, in order, in the form that a format needs.
class InputRows {
 public:
  virtual ~InputRows() = default;
  // The next rows, at most `max_rows`, each at the beginning of `stride` bytes of `block`, which gets the
  // size of them all. Returns their number; 0 at the end. Throws `Error`.
  virtual std::size_t next(std::size_t max_rows, std::size_t stride, std::vector<std::byte>& block) = 0;
  // Sets the positions of the rows last returned, in the scan: those of FileScan::open.
  virtual void positions(std::vector<Eigen::Vector3d>& positions) const = 0;
  // The indices of rows last returned that the format cannot hold, ascending: they have no finite position.
  virtual std::span<const std::size_t> left_out() const { return {}; }
};

// The union of the files' properties by name, in order of first appearance, packed. A property is double
// where types differ, and NaN or 0 in the rows of a file that has none. `is_left_out` says which do not
// count, by the index of a property.
using LeftOut = std::function<bool(const RowLayout& layout, std::size_t index)>;
RowLayout join_layouts(const std::vector<RowLayout>& layouts, const LeftOut& is_left_out);
// The joined rows of the files [first, end).
std::unique_ptr<InputRows> joined_rows(const FileScan& scan, RowLayout joined, std::size_t first,
                                       std::size_t end);
// Those of all files. Positions are relative to the offset, if there is one: x y z are floats then.
std::unique_ptr<InputRows> joined_rows(const FileScan& scan, RowLayout joined,
                                       const LocalOffset& offset = {});

// Calls visit(block, rows): rows of `input_bytes`, then the results, packed; all blocks in order, none larger
// than a few MiB for rows of usual size. Throws `Error`, with `name`, if rows and results differ in number.
void for_each_annotated_block(
    const Detection& detection, InputRows& input, std::size_t input_bytes,
    std::span<const ResultColumn> results, const std::string& name,
    const std::function<void(std::vector<std::byte>& block, std::size_t rows)>& visit);

}  // namespace lacuna::io
