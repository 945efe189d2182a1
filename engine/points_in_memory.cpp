// SPDX-License-Identifier: Apache-2.0
#include "engine/points_in_memory.hpp"

#include "engine/store/digest.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kTogether = 1 << 16;

template <class Scalar>
double load(const std::byte* from) {
  Scalar value;
  std::memcpy(&value, from, sizeof value);  // a column of a record may lie anywhere
  return static_cast<double>(value);
}

}  // namespace

std::vector<Eigen::Vector3d> PointArray::copy(std::size_t first, std::size_t count) const {
  std::vector<Eigen::Vector3d> points(count);
  const std::byte* from = first_ + static_cast<std::ptrdiff_t>(first) * point_stride_;
  for (Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::byte* const at = from + axis * coordinate_stride_;
      point[axis] = is_float_ ? load<float>(at) : load<double>(at);
    }
    from += point_stride_;
  }
  return points;
}

bool PointsInMemory::next(PointBatch& batch) {
  const std::size_t count = std::min(kTogether, points_.size() - next_);
  batch = {PointId{next_}, {}, points_.copy(next_, count), {}};
  if (has_normals()) batch.normals = normals_.copy(next_, count);
  next_ += count;
  return count > 0;
}

SourceParts PointsInMemory::parts() const {
  const auto text_of = [](const PointArray& vectors) {
    std::vector<Digest> digests;  // of blocks
    for (std::size_t first = 0; first < vectors.size(); first += kTogether) {
      const auto block = vectors.copy(first, std::min(kTogether, vectors.size() - first));
      digests.push_back(digest_of(std::as_bytes(std::span(block))));
    }
    const Digest digest = digest_of(std::as_bytes(std::span(digests)));
    return std::to_string(vectors.size()) + " " + std::to_string(digest[0]) + " " + std::to_string(digest[1]);
  };
  return {.identity = {"points " + text_of(points_) + ", normals " + text_of(normals_)}};
}

}  // namespace lacuna
