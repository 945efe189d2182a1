// SPDX-License-Identifier: Apache-2.0
#include "tests/support/memory_scan.hpp"

#include "engine/store/digest.hpp"

#include <algorithm>

namespace lacuna {

bool MemoryScan::next(PointBatch& batch) {
  const std::size_t end = std::min(next_ + batch_, end_);
  const auto part = [&](const std::vector<Eigen::Vector3d>& all) {
    if (all.empty()) return std::vector<Eigen::Vector3d>{};
    return std::vector(all.begin() + static_cast<std::ptrdiff_t>(next_),
                       all.begin() + static_cast<std::ptrdiff_t>(end));
  };
  batch = {PointId{value(id_) + next_ - first_}, {}, part(cloud_.positions), part(cloud_.normals)};
  next_ = end;
  return batch.size() > 0;
}

SourceParts MemoryScan::parts() const {
  const auto text_of = [](const std::vector<Eigen::Vector3d>& vectors) {
    return std::to_string(digest_of(std::as_bytes(std::span(vectors)))[0]);
  };
  SourceParts parts{.identity = {text_of(cloud_.positions), text_of(cloud_.normals)}};
  for (std::size_t part = 0; part < kParts; ++part)
    parts.points.push_back(first_of(part + 1) - first_of(part));
  return parts;
}

void MemoryScan::rewind_to(const IndexRange& parts, PointId first) {
  next_ = first_ = first_of(parts.first);
  end_ = first_of(parts.last);
  id_ = first;
}

Cloud read_points(PointSource& source) {
  Cloud all;
  PointBatch batch;
  while (source.next(batch)) {
    REQUIRE((batch.ids.empty() && value(batch.first) == all.size()));
    all.positions.insert(all.positions.end(), batch.positions.begin(), batch.positions.end());
    all.normals.insert(all.normals.end(), batch.normals.begin(), batch.normals.end());
  }
  CHECK(batch.size() == 0);
  CHECK(value(batch.first) == all.size());
  return all;
}

}  // namespace lacuna
