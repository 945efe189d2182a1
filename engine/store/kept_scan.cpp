// SPDX-License-Identifier: Apache-2.0
#include "engine/store/kept_scan.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna {
namespace {

constexpr std::size_t kVectorBytes = 3 * sizeof(double);
static_assert(sizeof(Eigen::Vector3d) == kVectorBytes);

}  // namespace

KeptScan::KeptScan(PointSource& scan, const std::filesystem::path& file)
    : scan_(scan), positions_(file.string() + ".positions"), normals_(file.string() + ".normals") {}

void KeptScan::rewind() {
  next_ = 0;
  if (!is_kept_) scan_.rewind();
}

bool KeptScan::next(PointBatch& batch) {
  return is_kept_ ? next_kept(batch) : next_of_source(batch);
}

bool KeptScan::next_of_source(PointBatch& batch) {
  if (!scan_.next(batch)) {
    points_ = next_;
    is_kept_ = true;
    return false;
  }
  assert(batch.ids.empty() && value(batch.first) == next_);
  positions_.write(next_ * kVectorBytes, std::as_bytes(std::span(batch.positions)));
  normals_.write(next_ * kVectorBytes, std::as_bytes(std::span(batch.normals)));
  next_ += batch.size();
  return true;
}

bool KeptScan::next_kept(PointBatch& batch) {
  constexpr std::uint64_t kTogether = 1 << 16;
  const std::uint64_t count = std::min(points_ - next_, kTogether);
  batch.first = PointId{next_};
  batch.ids.clear();
  batch.positions.resize(count);
  batch.normals.resize(has_normals() ? count : 0);
  positions_.read(next_ * kVectorBytes, std::as_writable_bytes(std::span(batch.positions)));
  normals_.read(next_ * kVectorBytes, std::as_writable_bytes(std::span(batch.normals)));
  next_ += count;
  return count > 0;
}

}  // namespace lacuna
