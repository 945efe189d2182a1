// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/explain/lids/make_lid.hpp"
#include "io/read/ply/ply.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace lacuna::io {
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
