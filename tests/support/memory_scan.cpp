// SPDX-License-Identifier: Apache-2.0
#include "tests/support/memory_scan.hpp"

#include "engine/store/digest.hpp"

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

std::vector<std::string> MemoryScan::identity() const {
  const auto text_of = [](const std::vector<Eigen::Vector3d>& vectors) {
    return std::to_string(digest_of(std::as_bytes(std::span(vectors)))[0]);
  };
  return {text_of(cloud_.positions), text_of(cloud_.normals)};
}

}  // namespace lacuna
