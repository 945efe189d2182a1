#include "engine/loops/raw_loops.hpp"

#include <algorithm>

namespace lacuna {

namespace {

constexpr std::uint64_t kBlock = 4096;  // points: a loop may be larger than memory

}  // namespace

void RawLoops::add(std::uint64_t points, const LoopEvidence& evidence,
                   const std::function<Vertex(std::uint64_t)>& vertex) {
  const std::lock_guard lock(*mutex_);
  index_.push_back({vertices_.size(), points, vertex(0).id, evidence});
  std::vector<Vertex> block;
  for (std::uint64_t i = 0; i < points; ++i) {
    block.push_back(vertex(i));
    if (block.size() < kBlock && i + 1 < points) continue;
    vertices_.append(block);
    block.clear();
  }
}

std::vector<Vertex> RawLoops::read(std::size_t loop) const {
  return vertices_.read(index_[loop].offset, index_[loop].points);
}

void RawLoops::for_each_vertex(std::size_t loop, const std::function<void(const Vertex&)>& visit) const {
  const std::uint64_t offset = index_[loop].offset, points = index_[loop].points;
  for (std::uint64_t i = 0; i < points; i += kBlock) {
    for (const Vertex& v : vertices_.read(offset + i, std::min(kBlock, points - i))) visit(v);
  }
}

bool RawLoops::comes_first(const Entry& a, const Entry& b) const {
  if (a.first != b.first) return a.first < b.first;
  if (a.points != b.points) return a.points < b.points;
  if (a.offset == b.offset) return false;
  ColumnReader<Vertex> of_a(vertices_), of_b(vertices_);
  for (std::uint64_t i = 0; i < a.points; ++i) {
    const PointId id_a = of_a[a.offset + i].id, id_b = of_b[b.offset + i].id;
    if (id_a != id_b) return id_a < id_b;
  }
  return a.evidence.is_coarse < b.evidence.is_coarse;
}

void RawLoops::sort() {
  std::sort(index_.begin(), index_.end(), [&](const Entry& a, const Entry& b) { return comes_first(a, b); });
}

}  // namespace lacuna
