// SPDX-License-Identifier: Apache-2.0
// Points on their way to a place: a tile, or a group of points that are set aside.
#pragma once

#include "engine/store/append_lists.hpp"
#include "engine/store/point_column.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

struct PointsAndNormals {
  std::vector<ScanPoint> points;
  std::vector<PlainNormal> normals;  // one for each point, or none
};
using VisitPoints = std::function<void(const PointsAndNormals&)>;

// How points lie on disk: 16 or 32 bytes each, and 24 for a normal.
struct PointLayout {
  Precision precision = Precision::kDouble;
  bool with_normals = false;

  std::size_t record_bytes() const;
  // Throws `Error` where the precision would lose a digit.
  std::vector<std::byte> pack(std::span<const ScanPoint> points, std::span<const PlainNormal> normals) const;
  PointsAndNormals unpack(std::span<const std::byte> records) const;
};

// The points of all places. What does not fit in memory is on disk, or all of them are in a sealed part.
class ScatteredPoints {
 public:
  ScatteredPoints(std::size_t places, PointLayout layout, const Spill& spill);
  ScatteredPoints(PartReader part, PointLayout layout) : layout_(layout), part_(std::move(part)) {}

  // From any thread.
  void add(std::size_t place, std::span<const ScanPoint> points, std::span<const PlainNormal> normals);
  // Calls visit(points) with all points of a place, some thousands at a time, in any order.
  void for_each(std::size_t place, const VisitPoints& visit) const;
  void write(PartWriter& part) const;

 private:
  void for_each_packed(std::size_t place, const std::function<void(std::span<const std::byte>)>& visit) const;

  PointLayout layout_;
  std::unique_ptr<AppendBytes> lists_;
  std::optional<PartReader> part_;
};

}  // namespace lacuna
