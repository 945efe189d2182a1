// SPDX-License-Identifier: Apache-2.0
#include "io/ply/ply_writer.hpp"
#include "io/results/annotated_rows.hpp"
#include "io/results/local_coordinates.hpp"
#include "io/results/points.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace lacuna::io {
namespace {

bool has_own_quality(const RowLayout& layout) {
  for (std::size_t i = 0; i < layout.properties.size(); ++i) {
    if (layout.properties[i].name == kQuality && !is_earlier_result(layout, i, {})) return true;
  }
  return false;
}

struct PlyColumns {
  std::vector<ResultColumn> results;
  RowLayout input;

  PlyColumns(const FileScan& scan, const OutputConfig& config) : results(result_columns(scan, config)) {
    const std::vector<RowLayout> layouts = written_layouts(scan, config);
    if (std::none_of(layouts.begin(), layouts.end(), has_own_quality)) {
      const auto loop = std::find_if(results.begin(), results.end(),
                                     [](const auto& result) { return result.name == kBeforeQuality; });
      results.insert(loop + 1, {std::string(kQuality), Scalar::kFloat32, results.front().offset});
    }
    input = join_layouts(layouts, [&](const RowLayout& layout, std::size_t i) {
      return is_earlier_result(layout, i, results);
    });
  }
};

}  // namespace

std::uint64_t ply_row_bytes(const FileScan& scan, const OutputConfig& config) {
  const PlyColumns columns(scan, config);
  return columns.input.stride + bytes_of(columns.results);
}

void write_points_ply(const Detection& detection, const FileScan& scan, const OutputConfig& config,
                      OutputFile& out) {
  const PlyColumns columns(scan, config);
  PlyElement vertex{.name = "vertex", .count = detection.summary.counts.points, .properties = {}};
  for (const Property& property : columns.input.properties)
    vertex.properties.push_back({property.name, property.type, {}});
  for (const ResultColumn& result : columns.results)
    vertex.properties.push_back({result.name, result.type, {}});
  const LocalOffset offset = local_offset(detection, config);
  PlyWriter writer(out, {vertex}, offset);
  const std::unique_ptr<InputRows> input = joined_rows(scan, columns.input, offset);
  for_each_annotated_block(detection, *input, columns.input.stride, columns.results, out.path().string(),
                           [&](const auto& block, std::size_t) { writer.put_bytes(block); });
  writer.finish();
}

}  // namespace lacuna::io
