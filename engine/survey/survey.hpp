// SPDX-License-Identifier: Apache-2.0
// survey: counts points per cell while they stream by.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/model/plain_box.hpp"
#include "engine/model/points.hpp"
#include "engine/store/point_column.hpp"
#include "engine/survey/cell_tree.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

// What a survey finds besides its cells, as plain data.
struct SurveyTotals {
  CellGrid grid;
  PlainBox bounds;                        // of the finite points; empty without any
  std::uint64_t points = 0;               // input rows
  std::uint64_t dropped = 0;              // with a non-finite coordinate
  std::uint64_t ids = 0;                  // all ids are below
  bool is_single = true;                  // every finite coordinate is a number of single precision
  std::array<std::uint8_t, 7> padding{};  // all bytes are in the checksum of a part

  Precision precision() const;
};

struct SurveyedScan : SurveyTotals {
  std::vector<CountedCell> cells;  // in an order of the tree; counts from 1 to `kMostCounted`
};

// One batch of points, counted per cell.
struct CellCounts {
  std::vector<CellRun> runs;  // in the order of the points
  Eigen::AlignedBox3d bounds;
  std::uint64_t points = 0;
  std::uint64_t dropped = 0;
  std::uint64_t ids = 0;
  bool is_single = true;
};
// Counts the points per cell. Throws `Error` where a point is so far away that squared distances could
// overflow.
CellCounts count_cells(const PointBatch& batch, const CellGrid& grid);

// Counts in an OpenVDB tree. The first batch sets a fine cell size. The size doubles, and counts merge,
// whenever the cells need more than `memory` bytes or hold too few points each. At the end they merge until a
// cell holds about `kPointsPerCell` points on average, and until OpenVDB's standard tree of the near cells
// fits. Cells that would hardly merge stay: they hold outliers, and larger ones would be too large for the
// other points. Cost: one access of the tree for each run of points in the same cell.
class Survey {
 public:
  // `expected_points`: 0 where not known.
  Survey(std::uint64_t memory, std::uint64_t expected_points);

  void add(const PointBatch& batch);
  // Chooses the cell size by a batch. Does nothing where it is chosen, or where no point of the batch is
  // finite.
  void choose_size(const PointBatch& batch);
  // Adding may take two steps: `add(count_cells(batch, finest()))`. The inner one may run in other threads. A
  // batch with a finite point must have been added before.
  bool is_sized() const { return sized_; }
  CellGrid finest() const { return {.finest = scan_.grid.finest, .origin = scan_.grid.origin}; }
  void add(const CellCounts& counts);
  SurveyedScan finish();

  // Another survey, of other points, may count from the same size on. `counts` returns what it has counted,
  // and `add` adds that. Ids of the added points follow those before.
  SurveyedScan counts();
  void add(const SurveyedScan& counts);

  static constexpr std::uint64_t kPointsPerCell = 16;

 private:
  void choose_cell_size(const PointBatch& batch);
  void add_runs(std::span<const CellRun> runs, int shift);
  bool needs_too_much() const;
  bool is_too_fine() const;
  bool can_merge() const { return scan_.grid.shift < CellGrid::kMaxShift; }
  void double_cell_size(CellTree merged);  // in cells of twice the size
  template <class Count>
  bool merge_if_dense(Count&& count);

  std::uint64_t memory_;
  bool is_expected_;  // whether the number of points is known
  std::uint64_t expected_points_;
  SurveyedScan scan_;
  std::atomic<bool> sized_ = false;
  CellTree counts_;
  std::uint64_t apart_ = 0;  // so many leaves would hardly have merged
};

}  // namespace lacuna
