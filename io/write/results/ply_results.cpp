// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/explain/lids/make_lid.hpp"
#include "io/read/ply/ply.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/results/points_form.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

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

namespace {

// A loop that is too long may be larger than memory, so no point of it is read.
Lid lid_of(const Detection& detection, std::size_t id) {
  const std::span<const InnerRing> islands = detection.inner_rings_of(id);
  std::uint64_t points = detection.loops[id].points;
  for (const InnerRing& island : islands) points += island.points;
  if (std::string reason = left_out(points, islands.size()); !reason.empty())
    return {.mesh = {}, .area = 0, .left_out = std::move(reason)};
  std::vector<Loop> rings;
  for (const InnerRing& island : islands) rings.push_back(detection.read_points(island.loop));
  return make_lid(detection.read_points(id), rings);
}

// The number of lids that are made before they are used. At most one for each thread is at work, or as many
// as fit in the memory.
std::size_t batch_size(std::uint64_t memory_limit) {
  const std::size_t threads = threads_here();
  const std::size_t fitting = std::max<std::uint64_t>(1, memory_limit / 4 / kLidBytes);
  constexpr std::size_t kRounds = 4;  // so that one large lid does not keep the other threads idle
  return fitting < threads ? fitting : kRounds * threads;
}

// Makes the lids of these holes, and passes them on in this order.
void for_each_lid(const Detection& detection, const std::vector<std::size_t>& holes,
                  const std::function<void(std::size_t id, const Lid&)>& visit) {
  const std::size_t batch = batch_size(detection.summary.memory_limit);
  for (std::size_t begin = 0; begin < holes.size(); begin += batch) {
    std::vector<Lid> lids(std::min(batch, holes.size() - begin));
    for_each_here(lids.size(), [&](std::size_t i) { lids[i] = lid_of(detection, holes[begin + i]); });
    for (std::size_t i = 0; i < lids.size(); ++i) visit(holes[begin + i], lids[i]);
  }
}

}  // namespace

std::vector<LidMeasures> measure_lids(const Detection& detection) {
  std::vector<LidMeasures> lids(detection.loops.size());
  std::vector<std::size_t> holes;
  for (std::size_t id = 0; id < detection.loops.size(); ++id) {
    if (detection.loops[id].kind == LoopKind::kHole) holes.push_back(id);
  }
  std::size_t without = 0;
  std::string first;
  for_each_lid(detection, holes, [&](std::size_t id, const Lid& lid) {
    if (lid.left_out.empty()) {
      lids[id] = {lid.mesh.vertices.size(), lid.mesh.triangles.size(), lid.area};
    } else if (without++ == 0) {
      first = std::to_string(id) + ": " + lid.left_out;
    }
  });
  if (without > 0)
    spdlog::warn("--lids: {} of {} holes have no lid; the first is hole {}", without, holes.size(), first);
  return lids;
}

void write_lids(const std::vector<LidMeasures>& lids, const Detection& detection, const ScanFiles& scan,
                const OutputConfig& config, OutputFile& out) {
  std::vector<std::size_t> holes;
  std::uint64_t vertices = 0, triangles = 0;
  for (std::size_t id = 0; id < lids.size(); ++id) {
    if (std::isnan(lids[id].area)) continue;
    holes.push_back(id);
    vertices += lids[id].vertices;
    triangles += lids[id].triangles;
  }
  if (vertices > std::numeric_limits<std::int32_t>::max()) {
    throw Error(out.path().string() + ": " + std::to_string(vertices) +
                " vertices of lids; the format allows 2147483647");
  }
  const Scalar coordinate = coordinate_type(scan, config);
  const PlyElement vertex{.name = "vertex",
                          .count = vertices,
                          .properties = {{"x", coordinate, {}},
                                         {"y", coordinate, {}},
                                         {"z", coordinate, {}},
                                         {"scalar_loop", Scalar::kInt32, {}}}};
  const PlyElement face{
      .name = "face", .count = triangles, .properties = {{"vertex_indices", Scalar::kInt32, Scalar::kUint8}}};
  constexpr std::uint64_t kListBytes = sizeof(std::uint8_t) + 3 * sizeof(std::int32_t);
  PlyWriter writer(out, {vertex, face}, local_offset(detection, config), triangles * kListBytes);
  for (const std::size_t id : holes) {
    const auto put = [&](const LoopPoint& point) {
      writer.put_position(coordinate, point.position());
      writer.put(static_cast<std::int32_t>(id));
    };
    detection.for_each_loop_point(id, put);
    for (const InnerRing& island : detection.inner_rings_of(id))
      detection.for_each_loop_point(island.loop, put);
  }
  std::uint32_t next = 0;
  for_each_lid(detection, holes, [&](std::size_t id, const Lid& lid) {
    for (const LidTriangle& corners : lid.mesh.triangles) {
      writer.put(std::uint8_t{3});
      for (const std::uint32_t corner : corners) writer.put(static_cast<std::int32_t>(next + corner));
    }
    next += static_cast<std::uint32_t>(lids[id].vertices);
  });
  writer.finish();
}

}  // namespace lacuna::io
