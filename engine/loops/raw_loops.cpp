#include "engine/loops/raw_loops.hpp"

#include <algorithm>

namespace lacuna {

// In blocks: a loop may be larger than memory.
void RawLoops::add(std::uint64_t points, double confidence,
                   const std::function<Vertex(std::uint64_t)>& vertex) {
  constexpr std::uint64_t kBlock = 4096;
  const std::lock_guard lock(*mutex_);
  ++found_;
  if (confidence < min_confidence_) return;
  index_.push_back({vertices_.size(), points, vertex(0).id, confidence});
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

void RawLoops::sort() {
  const auto ids = [&](const Entry& entry) {
    std::vector<PointId> ids;
    for (const Vertex& v : vertices_.read(entry.offset, entry.points)) ids.push_back(v.id);
    return ids;
  };
  std::sort(index_.begin(), index_.end(), [&](const Entry& a, const Entry& b) {
    if (a.first != b.first) return a.first < b.first;
    if (a.points != b.points) return a.points < b.points;
    return a.offset != b.offset && ids(a) < ids(b);
  });
}

}  // namespace lacuna
