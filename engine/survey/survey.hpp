// survey: counts points per cell while they stream by.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/model/points.hpp"
#include "engine/store/point_column.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

// Where counting stops: such a cell is divided anyway.
inline constexpr std::uint64_t kMostCounted = (std::uint64_t{1} << 31) - 1;

struct SurveyedScan {
  CellGrid grid;
  std::vector<CountedCell> cells;  // in no particular order; all counts > 0, none above `kMostCounted`
  Eigen::AlignedBox3d bounds;      // of the finite points; empty without any
  std::uint64_t points = 0;        // rows of the input
  std::uint64_t dropped = 0;       // with a non-finite coordinate
  bool is_single = true;           // every finite coordinate is a number of single precision

  Precision precision() const;
};

// Consecutive points in the same cell.
struct CellRun {
  CellCoord cell{};
  std::int32_t points = 0;
};

// One batch of points, counted per cell.
struct CellCounts {
  std::vector<CellRun> runs;  // in the order of the points
  Eigen::AlignedBox3d bounds;
  std::uint64_t points = 0;
  std::uint64_t dropped = 0;
  bool is_single = true;
};
CellCounts count_cells(const PointBatch& batch, const CellGrid& grid);

// Counts in OpenVDB leaves. The first batch sets a fine cell size; whenever the cells need more than `memory`
// bytes, or hold too few points each, the size doubles and counts merge, and once more at the end until a
// cell holds about `kPointsPerCell` points on average. Not where cells hardly merge: then they are those of
// outliers, far from all else, and the others would hold too many. Cost: one hashed access per run of points
// in the same cell.
class Survey {
 public:
  // `expected_points`: 0 where not known.
  Survey(std::uint64_t memory, std::uint64_t expected_points);
  ~Survey();

  void add(const PointBatch& batch);
  // The same in two steps, of which the first may run in other threads: `add(count_cells(batch, finest()))`,
  // once the first batch with a finite point has been added.
  bool is_sized() const { return sized_; }
  CellGrid finest() const { return {.finest = scan_.grid.finest, .origin = scan_.grid.origin}; }
  void add(const CellCounts& counts);
  // Throws `Error` where squared distances between points would overflow.
  SurveyedScan finish();

  static constexpr std::uint64_t kPointsPerCell = 16;

 private:
  struct Counts;
  void choose_cell_size(const PointBatch& batch);
  bool needs_too_much() const;
  bool is_too_fine() const;
  bool can_merge() const { return scan_.grid.shift < CellGrid::kMaxShift; }
  void take(std::unique_ptr<Counts> merged);  // in cells of twice the size
  template <class Count>
  bool merge_unless_apart(Count&& count);

  std::uint64_t memory_;
  bool is_told_;  // how many points to expect
  std::uint64_t expected_points_;
  SurveyedScan scan_;
  std::atomic<bool> sized_ = false;
  std::unique_ptr<Counts> counts_;
  std::uint64_t apart_ = 0;  // so many leaves would hardly have merged
};

}  // namespace lacuna
