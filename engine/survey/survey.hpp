// SPDX-License-Identifier: Apache-2.0
// survey: counts points per cell while the scan streams by, and so finds where they are.
#pragma once

#include "engine/config/job.hpp"
#include "engine/model/cell_grid.hpp"
#include "engine/model/plain_box.hpp"
#include "engine/model/points.hpp"
#include "engine/model/task_share.hpp"
#include "engine/store/point_column.hpp"
#include "engine/store/sorted_runs.hpp"
#include "engine/survey/cell_table.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
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
  std::vector<CountedCell> cells;  // along a Z curve; counts from 1 to `kMostCounted`
  std::uint64_t far_points = 0;    // in none of the cells: far from almost all other points
};

// One batch of points, counted per cell.
struct CellCounts {
  std::vector<CountedCell> runs;  // of consecutive points, in finest cells
  Eigen::AlignedBox3d bounds;
  std::uint64_t points = 0;
  std::uint64_t dropped = 0;
  std::uint64_t ids = 0;
  bool is_single = true;
};
// Counts the points per cell. Throws `Error` where a point is so far away that squared distances could
// overflow.
CellCounts count_cells(const PointBatch& batch, const CellGrid& grid);

// Idea: counts in a hash table. The first batch sets a fine cell size. Where the table is full, the size grows if
// that merges many cells. Else the cells go to the disk, and the table begins anew: cells of outliers merge
// at no size that suits the other points. At the end all cells are sorted along a Z curve, so that those of
// any larger size follow each other. Then the size doubles until a cell holds about `kPointsPerCell` points
// on average, unless cells would hardly merge. It also doubles until the index of the cells fits.
//
// Memory: `memory` bytes, however the points lie. Cost: one access of the table for each run of points in the
// same cell.
class Survey {
 public:
  // `expected_points`: 0 where not known. `file`: a temporary file.
  Survey(std::uint64_t memory, std::uint64_t expected_points, std::filesystem::path file);

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
  // without far points, and `add` adds that. Ids of the added points follow those before.
  SurveyedScan counts();
  void add(const SurveyedScan& counts);

  static constexpr std::uint64_t kPointsPerCell = 16;

 private:
  void choose_cell_size(const PointBatch& batch);
  void add_runs(std::span<const CountedCell> runs);
  bool is_full() const;
  void make_space();
  void store_cells();
  std::vector<std::uint64_t> count_by_shift();
  void collect_cells(std::optional<std::uint64_t> few, std::uint64_t most);
  bool does_index_fit() const;

  std::uint64_t expected_points_;
  std::uint64_t memory_;
  SurveyedScan scan_;
  std::atomic<bool> sized_ = false;
  CellTable table_;
  SortedRuns<CountedCell, AlongZCurve> stored_;
};

// Streams the scan once and counts its points per cell. Throws `Error`.
SurveyedScan survey_scan(PointSource& scan, Job& job);

// Several tasks may survey parts of the scan. Returns the counts of some parts, which `merge_surveys` merges
// in the order of the parts. Ids count from the first of these points.
SurveyedScan survey_parts(PointSource& scan, const IndexRange& parts, Job& job);
// Returns the survey of the whole scan. `expected_points`: as of the source.
SurveyedScan merge_surveys(std::size_t tasks, const std::function<SurveyedScan(std::size_t)>& survey_of_task,
                           std::optional<std::uint64_t> expected_points, const Spill& spill,
                           const Memory& memory);

}  // namespace lacuna
