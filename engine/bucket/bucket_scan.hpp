// SPDX-License-Identifier: Apache-2.0
// bucket: sorts the points into tiles on disk, each by the cell that holds it.
#pragma once

#include "engine/bucket/set_aside.hpp"
#include "engine/bucket/split.hpp"
#include "engine/config/job.hpp"
#include "engine/model/cell_grid.hpp"
#include "engine/model/points.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

namespace lacuna {

// A grid of OpenVDB with a number in each cell.
class CellIndex {
 public:
  static constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

  // `cells`, then `heavy`, numbered from 0.
  CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
            std::span<const CountedCell> heavy = {});
  CellIndex(CellIndex&&) noexcept;
  ~CellIndex();

  // Sets the number of each position's cell, and `kNoCell` where the cell has no number. From any thread.
  void find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> numbers) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

// Plans the tiles of a surveyed scan, as large as the memory limit allows. Consumes the survey's cells.
// Throws `Error` where the points do not fit on the disk.
TilePlan plan_tiles(SurveyedScan& survey, const Job& job);

// Streams the pass that the scan has begun, and brings every finite point to its place. Places are the tiles
// of the plan, and then its groups of points that are set aside. `expected_points`: for the progress; 0 where
// not known.
ScatteredPoints scatter_points(PointSource& scan, const TilePlan& plan, Precision precision,
                               std::uint64_t expected_points, Job& job);

// Stores every distinct point of a task's tiles, in cell order. The last task stores the points that are set
// aside, too. `bounds`: of all points. for_each(place, visit) calls visit(points) once or several times with
// all points of a place. `files`: empty ones for the store.
TileStore store_tiles(const TilePlan& plan, const TaskShare& share, const Eigen::AlignedBox3d& bounds,
                      const PointLayout& layout,
                      const std::function<void(std::size_t, const VisitPoints&)>& for_each, StoreFiles files,
                      const Workers& workers, Phases& phases);

}  // namespace lacuna
