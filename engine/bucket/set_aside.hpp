// SPDX-License-Identifier: Apache-2.0
// Points of cells that hold more points than a tile may, and points far from all others. They are far denser,
// or far farther away, than the survey's cells allow.
#pragma once

#include "engine/bucket/split.hpp"
#include "engine/bucket/z_curve.hpp"
#include "engine/store/sorted_runs.hpp"
#include "engine/store/store_writer.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna {

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
