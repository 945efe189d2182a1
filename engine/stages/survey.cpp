#include "engine/stages/survey.hpp"

#include <algorithm>
#include <cmath>
#include <openvdb/openvdb.h>

#include "engine/core/error.hpp"

namespace lacuna {
namespace {

// Beyond these the powers of two, or their squares, would leave the range of double.
constexpr int kMinExponent = -500;
constexpr int kMaxExponent = 500;

bool finite(const Eigen::Vector3d& p) { return p.allFinite(); }

// Twice the widest distance between quartiles: the extent of the points without their outliers.
double robust_extent(const PointBatch& batch) {
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : batch.positions) {
      if (finite(p)) values.push_back(p[axis]);
    }
    if (values.empty()) return 0;
    const auto quantile = [&](std::size_t quarter) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(quarter * (values.size() - 1) / 4);
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    extent = std::max(extent, 2 * (quantile(3) - quantile(1)));
  }
  return extent;
}

}  // namespace

struct Survey::Counts {
  openvdb::Int32Grid::Ptr grid = openvdb::Int32Grid::create(0);
  openvdb::Int32Grid::Accessor accessor = grid->getAccessor();
  std::uint64_t active = 0;

  void add(const CellCoord& cell, std::int32_t points) {
    accessor.modifyValue(openvdb::Coord(cell[0], cell[1], cell[2]), [&](std::int32_t& count) {
      if (count == 0) ++active;
      count += points;
    });
  }
};

Survey::Survey(std::uint64_t max_cells, std::uint64_t expected_points)
    : max_cells_(std::max<std::uint64_t>(max_cells, 1)), expected_points_(expected_points) {
  openvdb::initialize();
  counts_ = std::make_unique<Counts>();
}

Survey::~Survey() = default;

// A surface of n points and this extent has about sqrt(n / 16) cells of 16 points along it; a quarter of
// that size leaves room for a first batch that sees only a part of the scan.
void Survey::choose_cell_size(const PointBatch& batch) {
  const double points = static_cast<double>(std::max<std::uint64_t>(expected_points_, batch.size()));
  double extent = robust_extent(batch);
  if (extent == 0) {  // most points at one place: any size will do that is not lost beside the coordinates
    double largest = 0;
    for (const Eigen::Vector3d& p : batch.positions) {
      if (finite(p)) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    if (largest == 0) largest = 1;
    extent = largest;
  }
  const double edge = extent / (4 * std::sqrt(points / kPointsPerCell) + 1);
  scan_.grid.finest = std::clamp(std::ilogb(std::max(edge, 1e-300)), kMinExponent, kMaxExponent);
  sized_ = true;
}

void Survey::add(const PointBatch& batch) {
  if (!sized_ && std::any_of(batch.positions.begin(), batch.positions.end(), finite)) choose_cell_size(batch);
  scan_.points += batch.size();
  for (const Eigen::Vector3d& p : batch.positions) {
    if (!finite(p)) {
      ++scan_.dropped;
      continue;
    }
    scan_.bounds.extend(p);
    counts_->add(scan_.grid.cell_of(p), 1);
    if (counts_->active > max_cells_ && scan_.grid.shift < CellGrid::kMaxShift) coarsen();
  }
}

void Survey::coarsen() {
  auto coarse = std::make_unique<Counts>();
  for (auto cell = counts_->grid->cbeginValueOn(); cell; ++cell) {
    const openvdb::Coord coord = cell.getCoord();
    coarse->add({coord[0] >> 1, coord[1] >> 1, coord[2] >> 1}, *cell);
  }
  counts_ = std::move(coarse);
  ++scan_.grid.shift;
}

SurveyedScan Survey::finish() {
  const std::uint64_t finite_points = scan_.points - scan_.dropped;
  while (static_cast<double>(finite_points) < kPointsPerCell * static_cast<double>(counts_->active) &&
         counts_->active > 1 && scan_.grid.shift < CellGrid::kMaxShift) {
    coarsen();
  }
  if (finite_points > 0 && !std::isfinite(scan_.bounds.diagonal().squaredNorm())) {
    throw Error("the scan spans " + std::to_string(scan_.bounds.diagonal().norm()) +
                ": squared distances between its points overflow; coordinates must lie within 1e153");
  }
  scan_.cells.reserve(counts_->active);
  for (auto cell = counts_->grid->cbeginValueOn(); cell; ++cell) {
    const openvdb::Coord coord = cell.getCoord();
    scan_.cells.push_back({{coord[0], coord[1], coord[2]}, static_cast<std::uint64_t>(*cell)});
  }
  return std::move(scan_);
}

}  // namespace lacuna
