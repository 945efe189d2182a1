// SPDX-License-Identifier: Apache-2.0
// Points in memory as a source.
#pragma once

#include "engine/export.hpp"
#include "engine/model/points.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

template <class Vector>
concept IsVector = std::same_as<Vector, Eigen::Vector3d> || std::same_as<Vector, Eigen::Vector3f>;

// Points, or normals, as another program has them: double or float, at any stride. It does not own them.
class PointArray {
 public:
  PointArray() = default;
  // Vectors of Eigen, one behind the other.
  template <std::ranges::contiguous_range Range>
  requires IsVector<std::ranges::range_value_t<Range>> PointArray(const Range& points)
      : PointArray(points.empty() ? nullptr : std::ranges::data(points)->data(), std::ranges::size(points),
                   sizeof(std::ranges::range_value_t<Range>)) {}
  // `first`: the x of the first point. Strides in bytes, from point to point, and from x to y to z.
  PointArray(const double* first, std::size_t size, std::ptrdiff_t point_stride,
             std::ptrdiff_t coordinate_stride = sizeof(double))
      : first_(reinterpret_cast<const std::byte*>(first)),
        size_(size),
        point_stride_(point_stride),
        coordinate_stride_(coordinate_stride) {}
  PointArray(const float* first, std::size_t size, std::ptrdiff_t point_stride,
             std::ptrdiff_t coordinate_stride = sizeof(float))
      : first_(reinterpret_cast<const std::byte*>(first)),
        size_(size),
        point_stride_(point_stride),
        coordinate_stride_(coordinate_stride),
        is_float_(true) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  // Returns points [first, first + count).
  std::vector<Eigen::Vector3d> copy(std::size_t first, std::size_t count) const;

 private:
  const std::byte* first_ = nullptr;
  std::size_t size_ = 0;
  std::ptrdiff_t point_stride_ = 0, coordinate_stride_ = 0;
  bool is_float_ = false;
};

// A source whose batches are copies of the arrays. The arrays must outlive it.
class LACUNA_API PointsInMemory final : public PointSource {
 public:
  // `normals`: one for each point, or an empty array.
  PointsInMemory(const PointArray& points, const PointArray& normals) : points_(points), normals_(normals) {}

  void rewind() override { next_ = 0; }
  bool next(PointBatch& batch) override;
  std::optional<std::uint64_t> expected_points() const override { return points_.size(); }
  bool has_normals() const override { return !normals_.empty(); }
  SourceParts parts() const override;  // identified by all values

 private:
  PointArray points_, normals_;
  std::size_t next_ = 0;
};

}  // namespace lacuna
