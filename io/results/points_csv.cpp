// SPDX-License-Identifier: Apache-2.0
#include "io/results/annotated_rows.hpp"
#include "io/results/points.hpp"
#include "io/scalar.hpp"
#include "io/text/csv_writer.hpp"

#include <utility>

namespace lacuna::io {
namespace {

RowLayout input_layout(const FileScan& scan, std::span<const ResultColumn> results) {
  return join_layouts(scan.layouts(), [&](const RowLayout& layout, std::size_t i) {
    return is_earlier_result(layout, i, results);
  });
}

}  // namespace

FileMark points_csv_mark() {
  return {",scalar_boundary,scalar_coherent,scalar_loop", FileMark::kInFirstLine};
}

std::uint64_t csv_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  std::uint64_t bytes = 0;
  const auto add = [&](Scalar type) { bytes += is_integer(type) ? 3 : size_of(type) + 4; };
  for (const Property& property : input_layout(scan, results).properties) add(property.type);
  for (const ResultColumn& result : results) add(result.type);
  return bytes;
}

void write_points_csv(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const std::vector<ResultColumn> results = result_columns(scan, config);
  const RowLayout input = input_layout(scan, results);
  RowLayout all = input;
  for (const ResultColumn& result : results) {
    all.properties.push_back({.name = result.name, .type = result.type, .offset = all.stride});
    all.stride += size_of(result.type);
  }
  CsvWriter writer(out, all);
  const std::unique_ptr<InputRows> rows = joined_rows(scan, input);
  for_each_annotated_block(detection, *rows, input.stride, results, out.path().string(),
                           [&](const auto& block, std::size_t) { writer.put_rows(block); });
}

}  // namespace lacuna::io
