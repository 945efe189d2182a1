// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/results/points_form.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna::io {
namespace {

std::uint64_t count_points(const Detection& detection) {
  std::uint64_t count = 0;
  for (const LoopMeasures& loop : detection.loops) count += loop.points;
  return count;
}

}  // namespace

void write_loops(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                 OutputFile& out) {
  const std::uint64_t points = count_points(detection);
  if (points > std::numeric_limits<std::int32_t>::max()) {
    throw Error(out.path().string() + ": " + std::to_string(points) +
                " points on loops; the format allows 2147483647");
  }
  PlyElement vertex{
      .name = "vertex", .count = points, .properties = position_and_id(detection, scan, config)};
  const Scalar coordinate = vertex.properties.front().type;
  const Scalar id = vertex.properties.back().type;
  vertex.properties.insert(vertex.properties.end() - 1, {"scalar_loop", Scalar::kInt32, {}});
  vertex.properties.push_back({"scalar_outer", Scalar::kUint8, {}});
  vertex.properties.push_back({"quality", Scalar::kFloat32, {}});
  for (const char* colour : {"red", "green", "blue"})
    vertex.properties.push_back({colour, Scalar::kUint8, {}});
  // A closed loop has as many edges as points.
  const PlyElement edge{.name = "edge",
                        .count = points,
                        .properties = {{"vertex1", Scalar::kInt32, {}}, {"vertex2", Scalar::kInt32, {}}}};
  PlyWriter writer(out, {vertex, edge}, local_offset(detection, config));

  for (std::size_t loop = 0; loop < detection.loops.size(); ++loop) {
    const LoopMeasures& measures = detection.loops[loop];
    const LoopColour& colour = colour_of(measures.kind);
    detection.for_each_loop_point(loop, [&](const LoopPoint& point) {
      writer.put_position(coordinate, point.position());
      writer.put(static_cast<std::int32_t>(loop));
      writer.put_as(id, static_cast<double>(value(point.id)));
      writer.put(static_cast<std::uint8_t>(measures.kind == LoopKind::kOuter));
      writer.put(point.probability);
      for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) writer.put(part);
    });
  }
  std::int32_t first = 0;
  for (const LoopMeasures& loop : detection.loops) {
    const auto length = static_cast<std::int32_t>(loop.points);
    for (std::int32_t i = 0; i < length; ++i) {
      writer.put(first + i);
      writer.put(i + 1 < length ? first + i + 1 : first);
    }
    first += length;
  }
  writer.finish();
}

void write_boundary(const Detection& detection, const ScanFiles& scan, const OutputConfig& config,
                    OutputFile& out) {
  PlyElement vertex{.name = "vertex",
                    .count = detection.summary.counts.boundary_points,
                    .properties = position_and_id(detection, scan, config)};
  const Scalar coordinate = vertex.properties.front().type;
  const Scalar id = vertex.properties.back().type;
  vertex.properties.insert(vertex.properties.end() - 1, {"scalar_probability", Scalar::kFloat32, {}});
  vertex.properties.push_back({"scalar_loop", Scalar::kInt32, {}});
  vertex.properties.push_back({"quality", Scalar::kFloat32, {}});  // the probability as MeshLab has it
  PlyWriter writer(out, {vertex}, local_offset(detection, config));

  detection.for_each_boundary_point([&](const BoundaryPoint& point) {
    writer.put_position(coordinate, point.position());
    writer.put(point.probability);
    writer.put_as(id, static_cast<double>(value(point.id)));
    writer.put(point.loop);
    writer.put(point.probability);
  });
  writer.finish();
}

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
