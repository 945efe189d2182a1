// SPDX-License-Identifier: Apache-2.0
// Points on their way to a place: a tile, or a group of points that are set aside. Set aside are points of
// cells that hold more points than a tile may, and points far from all others. They are far denser, or far
// farther away, than the survey's cells allow.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/bucket/z_curve.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/point_column.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/store/sorted_runs.hpp"
#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

// Sorts the points on disk, group by group and along a Z curve through each group. One pass takes any density
// and any extent. Copies of a point follow each other, so they merge as they stream. Runs of the curve become
// tiles and cells. Memory: the memory of the sort, and one tile.
class SetAside {
 public:
  // `bounds`: the bounds of all points. The plan must outlive this.
  SetAside(const TilePlan& plan, const Eigen::AlignedBox3d& bounds, std::filesystem::path file,
           std::uint64_t memory);

  // Adds a point of a cell of the plan's group `group`. By one thread at a time.
  void add(std::uint32_t group, const ScanPoint& point, const PlainNormal& normal);

  // Puts the tiles into the store, once all points are added. Throws `Error` where a cell got other points
  // than were counted.
  void store(StoreWriter& store, std::uint64_t cell_points);

 private:
  struct Record {
    ScanPoint point;
    PlainNormal normal;
    ZPlace place;
    std::uint64_t group;
  };
  struct Before {
    bool operator()(const Record& a, const Record& b) const;
  };

  const TilePlan& plan_;
  std::vector<ZCurve> curves_;         // of each group
  std::vector<std::uint64_t> counts_;  // points that came
  SortedRuns<Record, Before> sort_;
};

}  // namespace lacuna
