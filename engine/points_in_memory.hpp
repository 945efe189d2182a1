// Points in memory as a source.
#pragma once

#include "engine/model/points.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Batches are copies. The arrays must outlive it.
class PointsInMemory final : public PointSource {
 public:
  // `normals`: one for each point, or none at all.
  PointsInMemory(std::span<const Eigen::Vector3d> points, std::span<const Eigen::Vector3d> normals)
      : points_(points), normals_(normals) {}

  void rewind() override { next_ = 0; }
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override { return points_.size(); }
  bool has_normals() const override { return !normals_.empty(); }
  std::vector<std::string> identity() const override;  // by all values

 private:
  std::span<const Eigen::Vector3d> points_, normals_;
  std::size_t next_ = 0;
};

}  // namespace lacuna
