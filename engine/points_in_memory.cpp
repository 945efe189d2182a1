#include "engine/points_in_memory.hpp"

#include <algorithm>
#include <vector>

namespace lacuna {

bool PointsInMemory::next(PointBatch& batch) {
  constexpr std::size_t kTogether = 1 << 16;
  const std::size_t count = std::min(kTogether, points_.size() - next_);
  const auto copy = [&](std::span<const Eigen::Vector3d> all) {
    const auto part = all.empty() ? all : all.subspan(next_, count);
    return std::vector(part.begin(), part.end());
  };
  batch = {PointId{next_}, {}, copy(points_), copy(normals_)};
  next_ += count;
  return count > 0;
}

}  // namespace lacuna
