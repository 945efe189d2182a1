// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/ply/ply_writer.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/results/annotated_rows.hpp"
#include "io/write/results/local_coordinates.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna::io {
namespace {

bool is_colour(std::string_view property) {
  return std::find(std::begin(kColourNames), std::end(kColourNames), property) != std::end(kColourNames);
}

RowLayout colour_columns(const ScanFiles& scan, const OutputConfig& config) {
  const bool with_colours = config.report || !scan.reads_slowly();
  return join_layouts(layouts_of(scan), [&](const RowLayout& layout, std::size_t i) {
    return !with_colours || !is_colour(layout.properties[i].name);
  });
}

constexpr std::array kComputed = {"nx", "ny", "nz", "scalar_probability"};

// Colours of chosen rows, which are requested in ascending id.
class ColourRows {
 public:
  ColourRows(const ScanFiles& scan, const RowLayout& layout)
      : stride_(layout.stride), rows_(scan, layout, {0, scan.files().size()}, std::nullopt) {}

  std::span<const std::byte> find(PointId id) {
    while (value(id) >= first_ + count_) {
      first_ += count_;
      count_ = rows_.next(kRowsAtATime, stride_, block_);
      if (count_ == 0) throw Error("the input has changed during the run; it must stay as it is");
    }
    return std::span(block_).subspan((value(id) - first_) * stride_, stride_);
  }

 private:
  static constexpr std::size_t kRowsAtATime = std::size_t{1} << 16;

  std::size_t stride_;
  JoinedRows rows_;
  std::vector<std::byte> block_;
  std::uint64_t first_ = 0, count_ = 0;  // id of the first row in memory, and how many there are
};

}  // namespace

void write_sample(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                  OutputFile& out) {
  PlyElement vertex{.name = "vertex",
                    .count = detection.sampled_points,
                    .properties = position_and_id(detection, scan, config)};
  const Scalar coordinate = vertex.properties.front().type;
  const Scalar id = vertex.properties.back().type;
  for (const char* const name : kComputed) vertex.properties.push_back({name, Scalar::kFloat32, {}});
  const RowLayout columns = colour_columns(scan, config);
  for (const Property& column : columns.properties)
    vertex.properties.push_back({column.name, column.type, {}});
  PlyWriter writer(out, {vertex}, local_offset(detection, config));

  ColourRows colours(scan, columns);
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    writer.put_position(coordinate, point.position());
    writer.put_as(id, static_cast<double>(value(point.id)));
    for (const float component : point.normal) writer.put(component);
    writer.put(point.probability);
    if (columns.stride > 0) writer.put_bytes(colours.find(point.id));
  });
  writer.finish();
}

}  // namespace lacuna::io
