#include "engine/stages/survey.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <openvdb/openvdb.h>

namespace lacuna {
namespace {

// Beyond these the powers of two, or their squares, would leave the range of double.
constexpr int kMinExponent = -500;
constexpr int kMaxExponent = 500;

// Of a scan that does not tell: rather too fine than too coarse.
constexpr std::uint64_t kUnknownPoints = 1 << 24;

// A cell's share of the index and the tree built from it.
constexpr std::uint64_t kBytesPerCell = 96;

bool finite(const Eigen::Vector3d& p) {
  return p.allFinite();
}

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

// A cell's place among those of a batch, by the leaf of the grid that holds it.
class LeafOrder {
 public:
  explicit LeafOrder(std::span<const CellCoord> cells) {
    CellCoord high{INT32_MIN, INT32_MIN, INT32_MIN};
    for (const CellCoord& cell : cells) {
      for (int axis = 0; axis < 3; ++axis) {
        low_[axis] = std::min(low_[axis], cell[axis]);
        high[axis] = std::max(high[axis], cell[axis]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] &= ~7;
      fits_ &= std::int64_t{high[axis]} - low_[axis] < 1 << 21;
    }
  }

  bool fits() const { return fits_; }

  std::uint64_t place(const CellCoord& cell) const {
    std::uint64_t leaf = 0, within = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<std::uint64_t>(cell[axis] - low_[axis]);
      leaf = leaf << 18 | steps >> 3;
      within = within << 3 | (steps & 7);
    }
    return leaf << 9 | within;
  }

  CellCoord cell(std::uint64_t place) const {
    CellCoord cell;
    for (int axis = 2; axis >= 0; --axis) {
      const int up = 2 - axis;
      const std::uint64_t steps = (place >> (9 + 18 * up) & 0x3ffff) << 3 | (place >> 3 * up & 7);
      cell[axis] = low_[axis] + static_cast<std::int32_t>(steps);
    }
    return cell;
  }

 private:
  CellCoord low_{INT32_MAX, INT32_MAX, INT32_MAX};
  bool fits_ = true;
};

}  // namespace

struct Survey::Counts {
  using Leaf = openvdb::Int32Tree::LeafNodeType;

  openvdb::Int32Grid::Ptr grid = openvdb::Int32Grid::create(0);
  openvdb::Int32Grid::Accessor accessor = grid->getAccessor();
  std::uint64_t cells = 0;
  std::uint64_t leaves = 0;

  void add(const CellCoord& cell, std::int32_t points) {
    const openvdb::Coord coord(cell[0], cell[1], cell[2]);
    bool is_new = false;
    accessor.modifyValue(coord, [&](std::int32_t& count) {
      is_new = count == 0;
      count += points;
    });
    if (!is_new) return;
    ++cells;
    if (accessor.getNode<Leaf>()->onVoxelCount() == 1) ++leaves;
  }

  std::uint64_t bytes() const {
    return leaves * sizeof(Leaf) + leaves * sizeof(Leaf::Buffer::ValueType) * Leaf::SIZE;
  }
};

CellCounts count_cells(const PointBatch& batch, const CellGrid& grid) {
  CellCounts counts{.points = batch.size()};
  std::vector<CellCoord> cells;
  cells.reserve(batch.size());
  for (const Eigen::Vector3d& p : batch.positions) {
    if (!finite(p)) {
      ++counts.dropped;
      continue;
    }
    counts.bounds.extend(p);
    cells.push_back(grid.cell_of(p));
  }
  const LeafOrder order(cells);
  if (!order.fits()) {
    for (const CellCoord& cell : cells) counts.cells.push_back({cell, 1});
    return counts;
  }
  std::vector<std::uint64_t> places;
  places.reserve(cells.size());
  for (const CellCoord& cell : cells) places.push_back(order.place(cell));
  std::sort(places.begin(), places.end());
  for (std::size_t begin = 0, end; begin < places.size(); begin = end) {
    for (end = begin; end < places.size() && places[end] == places[begin];) ++end;
    counts.cells.push_back({order.cell(places[begin]), end - begin});
  }
  return counts;
}

Survey::Survey(std::uint64_t memory, std::uint64_t expected_points)
    : memory_(memory), expected_points_(expected_points > 0 ? expected_points : kUnknownPoints) {
  openvdb::initialize();
  counts_ = std::make_unique<Counts>();
}

Survey::~Survey() = default;

// A surface of n points and this extent has sqrt(n / 16) cells of 16 points along it; half of that size
// leaves room for a first batch that sees only a part of the scan.
void Survey::choose_cell_size(const PointBatch& batch) {
  const double points = static_cast<double>(expected_points_);
  double extent = robust_extent(batch);
  if (extent == 0) {  // most points at one place: any size will do that is not lost beside the coordinates
    double largest = 0;
    for (const Eigen::Vector3d& p : batch.positions) {
      if (finite(p)) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    if (largest == 0) largest = 1;
    extent = largest;
  }
  const double edge = extent / (2 * std::sqrt(points / kPointsPerCell) + 1);
  scan_.grid.finest = std::clamp(std::ilogb(std::max(edge, 1e-300)), kMinExponent, kMaxExponent);
  sized_ = true;
}

void Survey::add(const PointBatch& batch) {
  if (!sized_ && std::any_of(batch.positions.begin(), batch.positions.end(), finite)) choose_cell_size(batch);
  add(count_cells(batch, finest()));
}

void Survey::add(const CellCounts& counts) {
  scan_.points += counts.points;
  scan_.dropped += counts.dropped;
  scan_.bounds.extend(counts.bounds);
  for (const CountedCell& cell : counts.cells) {
    const int shift = scan_.grid.shift;
    counts_->add({cell.coord[0] >> shift, cell.coord[1] >> shift, cell.coord[2] >> shift},
                 static_cast<std::int32_t>(cell.points));
    if (is_too_fine() && scan_.grid.shift < CellGrid::kMaxShift) coarsen();
  }
}

bool Survey::is_too_fine() const {
  // Even with all points to come in the same cells, these would hold too few.
  const bool sparse =
      counts_->cells > 1024 && counts_->cells > expected_points_ / 4 && counts_->cells > scan_.points / 4;
  return sparse || counts_->bytes() + counts_->cells * kBytesPerCell > memory_;
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
  while (static_cast<double>(finite_points) < kPointsPerCell * static_cast<double>(counts_->cells) &&
         counts_->cells > 1 && scan_.grid.shift < CellGrid::kMaxShift) {
    coarsen();
  }
  if (finite_points > 0 && !std::isfinite(scan_.bounds.diagonal().squaredNorm())) {
    throw Error("the scan spans " + std::to_string(scan_.bounds.diagonal().norm()) +
                ": squared distances between its points overflow; coordinates must lie within 1e153");
  }
  scan_.cells.reserve(counts_->cells);
  for (auto cell = counts_->grid->cbeginValueOn(); cell; ++cell) {
    const openvdb::Coord coord = cell.getCoord();
    scan_.cells.push_back({{coord[0], coord[1], coord[2]}, static_cast<std::uint64_t>(*cell)});
  }
  return std::move(scan_);
}

}  // namespace lacuna
