// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/ply/ply_writer.hpp"
#include "io/write/loops/loop_colours.hpp"
#include "io/write/results/local_coordinates.hpp"
#include "io/write/results/results.hpp"

#include <limits>

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

}  // namespace lacuna::io
