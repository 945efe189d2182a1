// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/raw_loops.hpp"

#include "engine/store/column_writer.hpp"

#include <algorithm>

namespace lacuna {

void RawLoops::add(std::uint64_t points, const LoopEvidence& evidence,
                   const std::function<Vertex(std::uint64_t)>& vertex) {
  const std::lock_guard lock(*mutex_);
  index_.push_back({vertices_.size(), points, vertex(0).id, evidence});
  ColumnWriter<Vertex> writer(vertices_);
  for (std::uint64_t i = 0; i < points; ++i) writer.add(vertex(i));
  writer.finish();
}

std::vector<Vertex> RawLoops::read(std::size_t loop) const {
  return vertices_.read(index_[loop].offset, index_[loop].points);
}

void RawLoops::for_each_vertex(std::size_t loop, const std::function<void(const Vertex&)>& visit) const {
  const std::uint64_t begin = index_[loop].offset;
  ColumnReader<Vertex> vertices(vertices_);
  for (std::uint64_t i = begin; i < begin + index_[loop].points; ++i) visit(vertices[i]);
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
