// survey: counts points per cell while they stream by.
#pragma once

#include "engine/data/points.hpp"
#include "engine/data/tiling.hpp"

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

struct SurveyedScan {
  CellGrid grid;
  std::vector<CountedCell> cells;  // in no particular order; all counts > 0
  Eigen::AlignedBox3d bounds;      // of the finite points; empty without any
  std::uint64_t points = 0;        // rows of the input
  std::uint64_t dropped = 0;       // with a non-finite coordinate
};

// Counts in a sparse OpenVDB grid. The first batch sets a fine cell size; whenever the cells need more than
// `memory` bytes, or hold too few points each, the size doubles and counts merge, and once more at the end
// until a cell holds about `kPointsPerCell` points on average. Cost: one hashed access per point.
class Survey {
 public:
  // `expected_points`: 0 where not known.
  Survey(std::uint64_t memory, std::uint64_t expected_points);
  ~Survey();

  void add(const PointBatch& batch);
  // Throws `Error` where squared distances between points would overflow.
  SurveyedScan finish();

  static constexpr double kPointsPerCell = 16;

 private:
  struct Counts;
  void choose_cell_size(const PointBatch& batch);
  bool is_too_fine() const;
  void coarsen();

  std::uint64_t memory_;
  std::uint64_t expected_points_;
  SurveyedScan scan_;
  bool sized_ = false;
  std::unique_ptr<Counts> counts_;
};

}  // namespace lacuna
