#include "tests/support/memory_scan.hpp"

#include <algorithm>

namespace lacuna {

bool MemoryScan::next(PointBatch& batch) {
  const std::size_t end = std::min(next_ + batch_, cloud_.size());
  const auto part = [&](const std::vector<Eigen::Vector3d>& all) {
    if (all.empty()) return std::vector<Eigen::Vector3d>{};
    return std::vector(all.begin() + static_cast<std::ptrdiff_t>(next_),
                       all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  batch = {PointId{next_}, {}, part(cloud_.positions), part(cloud_.normals)};
  next_ = end;
  return batch.size() > 0;
}

}  // namespace lacuna
