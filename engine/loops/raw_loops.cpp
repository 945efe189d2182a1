#include "engine/loops/raw_loops.hpp"

#include <algorithm>

namespace lacuna {

void RawLoops::add(std::span<const Vertex> loop, double confidence) {
  const std::lock_guard lock(*mutex_);
  ++found_;
  if (confidence < min_confidence_) return;
  const std::uint64_t offset = vertices_.append(loop);
  index_.push_back({offset, loop.size(), loop.front().id, confidence});
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
