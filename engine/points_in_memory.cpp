#include "engine/points_in_memory.hpp"

#include "engine/store/sealed_part.hpp"

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

std::vector<std::string> PointsInMemory::identity() const {
  const auto text_of = [](std::span<const Eigen::Vector3d> vectors) {
    const Digest digest = digest_of(std::as_bytes(vectors));
    return std::to_string(vectors.size()) + " " + std::to_string(digest[0]) + " " + std::to_string(digest[1]);
  };
  return {"points " + text_of(points_) + ", normals " + text_of(normals_)};
}

}  // namespace lacuna
