// SPDX-License-Identifier: Apache-2.0
#include "engine/run/parallel.hpp"
#include "io/files/number.hpp"
#include "io/lids/make_lid.hpp"
#include "io/loops/lids_reader.hpp"
#include "io/results/lids.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace lacuna::io {
namespace {

struct HoleToClose {
  std::size_t id;
  std::string left_out;
  Loop loop;
  std::vector<Loop> islands;
};

Lid lid_of(const HoleToClose& hole) {
  return hole.left_out.empty() ? make_lid(hole.loop, hole.islands)
                               : Lid{.mesh = {}, .area = 0, .left_out = hole.left_out};
}

// A loop that is too long may be larger than memory, so no point of it is read.
HoleToClose read_fitting(const Detection& detection, std::size_t id) {
  const std::span<const InnerRing> islands = detection.inner_rings_of(id);
  std::uint64_t points = detection.loops[id].points;
  for (const InnerRing& island : islands) points += island.points;
  HoleToClose hole{.id = id, .left_out = left_out(points, islands.size()), .loop = {}, .islands = {}};
  if (!hole.left_out.empty()) return hole;
  hole.loop = detection.read_points(id);
  for (const InnerRing& island : islands) hole.islands.push_back(detection.read_points(island.loop));
  return hole;
}

std::string head_of(std::size_t id, const Lid& lid) {
  std::string text = "\n# " + std::string(kLidVertices) + " " + std::to_string(lid.mesh.vertices.size()) +
                     "\n# " + std::string(kLidTriangles) + " " + std::to_string(lid.mesh.triangles.size()) +
                     "\n# " + std::string(kLidArea) + " ";
  append_shortest(text, lid.area);
  return text + "\no hole_" + std::to_string(id) + "\n";
}

void write_lid(std::size_t id, const Lid& lid, std::uint64_t first, OutputFile& out) {
  if (!lid.left_out.empty()) {
    out.write("\n# hole_" + std::to_string(id) + std::string(kNoLid) + lid.left_out + "\n");
    return;
  }
  out.write(head_of(id, lid));
  std::string line;
  for (const Eigen::Vector3d& vertex : lid.mesh.vertices) {
    line.assign(1, 'v');
    for (const double component : vertex) {
      line.push_back(' ');
      append_plain(line, component);
    }
    line.push_back('\n');
    out.write(line);
  }
  for (const LidTriangle& triangle : lid.mesh.triangles) {
    line.assign(1, 'f');
    for (const std::uint32_t corner : triangle) line.append(1, ' ').append(std::to_string(first + corner));
    line.push_back('\n');
    out.write(line);
  }
}

// The number of lids that are made before they are written. At most one for each thread is at work, or as
// many as fit in the memory.
std::size_t batch_size(std::uint64_t memory_limit) {
  const std::size_t threads = threads_here();
  const std::size_t fitting = std::max<std::uint64_t>(1, memory_limit / 4 / kLidBytes);
  constexpr std::size_t kRounds = 4;  // so that one large lid does not keep the other threads idle
  return fitting < threads ? fitting : kRounds * threads;
}

}  // namespace

void write_lids_obj(const Detection& detection, OutputFile& out) {
  std::vector<std::size_t> holes;
  for (std::size_t id = 0; id < detection.loops.size(); ++id) {
    if (detection.loops[id].kind == LoopKind::kHole) holes.push_back(id);
  }
  out.write("# lacuna detect, lids\n");
  const std::size_t batch = batch_size(detection.summary.memory_limit);
  std::uint64_t next = 1;  // vertices count from 1, over all objects
  for (std::size_t begin = 0; begin < holes.size(); begin += batch) {
    const std::size_t count = std::min(batch, holes.size() - begin);
    std::vector<HoleToClose> to_close;
    for (std::size_t i = 0; i < count; ++i) to_close.push_back(read_fitting(detection, holes[begin + i]));
    std::vector<Lid> lids(count);
    for_each_here(count, [&](std::size_t i) { lids[i] = lid_of(to_close[i]); });
    for (std::size_t i = 0; i < count; ++i) {
      write_lid(to_close[i].id, lids[i], next, out);
      next += lids[i].mesh.vertices.size();
    }
  }
}

}  // namespace lacuna::io
