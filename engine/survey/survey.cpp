#include "engine/survey/survey.hpp"

#include "engine/run/error.hpp"
#include "engine/survey/leaf_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace lacuna {
namespace {

// Beyond these the powers of two, or their squares, would leave the range of double.
constexpr int kMinExponent = -500;
constexpr int kMaxExponent = 500;

// Of a scan that does not tell: rather too fine than too coarse.
constexpr std::uint64_t kUnknownPoints = 1 << 24;

// A cell's share of the index and the tree built from it.
constexpr std::uint64_t kBytesPerCell = 96;

CellCoord ancestor(const CellCoord& cell, int doublings) {
  return {cell[0] >> doublings, cell[1] >> doublings, cell[2] >> doublings};
}

bool finite(const Eigen::Vector3d& p) {
  return p.allFinite();
}

// Where the points are, their outliers aside.
struct Whereabouts {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // median along each axis
  double extent = 0;                                 // twice the widest distance between quartiles
  double farthest = 0;                               // largest coordinate
};

Whereabouts whereabouts_of(const PointBatch& batch) {
  Whereabouts place;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Eigen::Vector3d& p : batch.positions) {
      if (!finite(p)) continue;
      values.push_back(p[axis]);
      place.farthest = std::max(place.farthest, std::fabs(p[axis]));
    }
    if (values.empty()) return place;
    const auto quantile = [&](std::size_t quarter) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(quarter * (values.size() - 1) / 4);
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    place.middle[axis] = quantile(2);
    place.extent = std::max(place.extent, 2 * (quantile(3) - quantile(1)));
  }
  return place;
}

// The cell that holds the point is at (0, 0, 0).
std::array<double, 3> origin_at(const Eigen::Vector3d& point, int finest) {
  const double scale = std::ldexp(1.0, -finest);
  return {std::floor(point.x() * scale), std::floor(point.y() * scale), std::floor(point.z() * scale)};
}

constexpr std::size_t kMostRuns = 256;

// visit(part): parts that are counted at a time.
template <class Visit>
void for_each_part(std::span<const CellRun> runs, Visit&& visit) {
  for (; !runs.empty(); runs = runs.subspan(std::min(runs.size(), kMostRuns)))
    visit(runs.first(std::min(runs.size(), kMostRuns)));
}

// Whether most cells, or leaves, did not merge when the size doubled: of a surface a quarter is left, of a
// line the half. Few say nothing.
bool lie_apart(std::uint64_t before, std::uint64_t after) {
  constexpr std::uint64_t kTelling = 64;
  return before >= kTelling && 4 * after > 3 * before;
}

}  // namespace

struct Survey::Counts {
  using Leaves = LeafTable<std::int32_t>;
  using Leaf = Leaves::Leaf;

  Leaves leaves{0};
  std::uint64_t cells = 0;

  std::uint64_t leaf_count() const { return leaves.leaves().size(); }

  // visit(cell, points)
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    for (const auto& leaf : leaves.leaves()) {
      for (auto cell = leaf->cbeginValueOn(); cell; ++cell) {
        const openvdb::Coord coord = cell.getCoord();
        visit(CellCoord{coord[0], coord[1], coord[2]}, *cell);
      }
    }
  }

  // In cells of twice the size.
  std::unique_ptr<Counts> merged() const {
    auto merged = std::make_unique<Counts>();
    std::array<CellRun, kMostRuns> runs;
    std::size_t count = 0;
    const auto add_runs = [&] { merged->add(std::span(runs).first(std::exchange(count, 0)), 1); };
    for_each_cell([&](const CellCoord& cell, std::int32_t points) {
      runs[count++] = {cell, points};
      if (count == runs.size()) add_runs();
    });
    add_runs();
    return merged;
  }

  // Those of surfaces: an outlier's is alone in its leaf.
  std::uint64_t cells_in_company() const {
    return cells - static_cast<std::uint64_t>(
                       std::count_if(leaves.leaves().begin(), leaves.leaves().end(),
                                     [](const auto& leaf) { return leaf->onVoxelCount() == 1; }));
  }

  // Where all the counts are, then the counts: the cache misses of points in random order overlap. `shift`:
  // doublings from the runs' cells to those of the grid.
  void add(std::span<const CellRun> runs, int shift) {
    struct Place {
      Leaf* leaf;
      std::int32_t* count;
      std::uint32_t offset;
    };
    std::array<Place, kMostRuns> places;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const CellCoord cell = ancestor(runs[i].cell, shift);
      const auto& entry = leaves.touch(cell);
      const std::uint32_t offset = leaves.offset(cell);
      places[i] = {entry.leaf, entry.values + offset, offset};
      __builtin_prefetch(places[i].count, 1);
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto& [leaf, count, offset] = places[i];
      if (*count == 0) {
        leaf->setValueOn(offset, 0);
        ++cells;
      }
      *count = static_cast<std::int32_t>(
          std::min<std::int64_t>(std::int64_t{*count} + runs[i].points, kMostCounted));
    }
  }
};

Precision SurveyedScan::precision() const {
  constexpr std::uint64_t kIds = std::uint64_t{1} << 32;
  return is_single && points <= kIds ? Precision::kSingle : Precision::kDouble;
}

CellCounts count_cells(const PointBatch& batch, const CellGrid& grid) {
  CellCounts counts{.points = batch.size()};
  const std::span<const Eigen::Vector3d> positions = batch.positions;
  counts.runs.reserve(positions.size());
  std::array<CellCoord, 256> cells;
  for (std::size_t first = 0; first < positions.size(); first += cells.size()) {
    const std::size_t count = std::min(cells.size(), positions.size() - first);
    grid.cells_of(positions.subspan(first, count), std::span(cells).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& p = positions[first + i];
      if (!finite(p)) {
        ++counts.dropped;
        continue;
      }
      counts.bounds.extend(p);
      counts.is_single &= p.cast<float>().cast<double>() == p;
      if (counts.runs.empty() || !same_cell(counts.runs.back().cell, cells[i]))
        counts.runs.push_back({cells[i], 0});
      ++counts.runs.back().points;
    }
  }
  return counts;
}

Survey::Survey(std::uint64_t memory, std::uint64_t expected_points)
    : memory_(memory),
      is_told_(expected_points > 0),
      expected_points_(is_told_ ? expected_points : kUnknownPoints),
      counts_(std::make_unique<Counts>()) {}

Survey::~Survey() = default;

// A surface of n points and this extent has sqrt(n / 16) cells of 16 points along it; half of that size
// leaves room for a first batch that sees only a part of the scan. Where it sees the whole scan, in random
// order, its cells tell how many there will be: sizes with several times too many are passed over.
void Survey::choose_cell_size(const PointBatch& batch) {
  const double points = static_cast<double>(expected_points_);
  const Whereabouts place = whereabouts_of(batch);
  const double farthest = place.middle.cwiseAbs().maxCoeff();
  double extent = place.extent;
  if (extent == 0) extent = place.farthest > 0 ? place.farthest : 1;  // most points at one place
  const double edge = extent / (2 * std::sqrt(points / kPointsPerCell) + 1);
  // Cells below the last digit of the coordinates would divide nothing.
  const int digit = farthest > 0 ? std::ilogb(farthest) - std::numeric_limits<double>::digits : kMinExponent;
  scan_.grid.finest =
      std::clamp(std::ilogb(std::max(edge, 1e-300)), std::max(digit, kMinExponent), kMaxExponent);
  scan_.grid.origin = origin_at(place.middle, scan_.grid.finest);

  // Cells as much larger as the batch is thinner than the scan, then as many times more as they divide into.
  const double thinner = std::max(points / static_cast<double>(batch.size()), 1.0);
  int doublings = std::ilogb(thinner) / 2;
  const std::vector<CellRun> runs = count_cells(batch, scan_.grid).runs;
  Counts seen;
  const auto count = [&] {
    seen = Counts();
    for (std::span<const CellRun> rest = runs; !rest.empty();
         rest = rest.subspan(std::min(rest.size(), kMostRuns))) {
      if (seen.leaves.bytes() > memory_) return false;
      seen.add(rest.first(std::min(rest.size(), kMostRuns)), doublings);
    }
    return true;
  };
  while (!count() && doublings < CellGrid::kMaxShift) ++doublings;
  const double most = 2 * points / kPointsPerCell;
  for (double cells = std::ldexp(seen.cells_in_company(), 2 * doublings); cells > most; cells /= 4)
    ++scan_.grid.finest;
  scan_.grid.origin = origin_at(place.middle, scan_.grid.finest);
  sized_ = true;
}

void Survey::take(std::unique_ptr<Counts> merged) {
  counts_ = std::move(merged);
  ++scan_.grid.shift;
}

// count(counts): of what most have to merge, else nothing does.
template <class Count>
bool Survey::merge_unless_apart(Count&& count) {
  std::unique_ptr<Counts> merged = counts_->merged();
  if (lie_apart(count(*counts_), count(*merged))) return false;
  take(std::move(merged));
  return true;
}

void Survey::add(const PointBatch& batch) {
  if (!sized_ && std::any_of(batch.positions.begin(), batch.positions.end(), finite)) choose_cell_size(batch);
  add(count_cells(batch, finest()));
}

void Survey::add(const CellCounts& counts) {
  scan_.points += counts.points;
  scan_.dropped += counts.dropped;
  scan_.bounds.extend(counts.bounds);
  scan_.is_single &= counts.is_single;
  for_each_part(counts.runs, [&](std::span<const CellRun> runs) {
    counts_->add(runs, scan_.grid.shift);
    while (needs_too_much() && can_merge()) take(counts_->merged());
    while (is_too_fine() && can_merge()) {
      // Leaves, since in random order cells have few points at first, and hardly merge.
      if (merge_unless_apart([](const Counts& counts) { return counts.leaf_count(); })) continue;
      apart_ = counts_->leaf_count();
      break;
    }
  });
}

bool Survey::needs_too_much() const {
  return counts_->leaves.bytes() + counts_->cells * kBytesPerCell > memory_;
}

bool Survey::is_too_fine() const {
  if (counts_->leaf_count() <= 2 * apart_) return false;
  // Even with all points to come in the same cells, these would hold too few in the end. A scan that does not
  // tell may have more points than its cells were made for.
  const std::uint64_t points = std::max(scan_.points, is_told_ ? expected_points_ : 4 * expected_points_);
  // In random order leaves are touched before their cells are: a surface fills about 50 cells of those that
  // it passes through.
  constexpr std::uint64_t kSurelyFilled = 24;
  const std::uint64_t most = std::max<std::uint64_t>(points / kPointsPerCell, 1024);
  return counts_->cells > most || counts_->leaf_count() * kSurelyFilled > most;
}

SurveyedScan Survey::finish() {
  const std::uint64_t finite_points = scan_.points - scan_.dropped;
  while (finite_points < kPointsPerCell * counts_->cells && counts_->cells > 1 && can_merge() &&
         merge_unless_apart([](const Counts& counts) { return counts.cells; })) {
  }
  if (finite_points > 0 && !std::isfinite(scan_.bounds.diagonal().squaredNorm())) {
    throw Error("the scan spans " + std::to_string(scan_.bounds.diagonal().norm()) +
                ": squared distances between its points overflow; coordinates must lie within 1e153");
  }
  scan_.cells.reserve(counts_->cells);
  counts_->for_each_cell([&](const CellCoord& cell, std::int32_t points) {
    scan_.cells.push_back({cell, static_cast<std::uint64_t>(points)});
  });
  return std::move(scan_);
}

}  // namespace lacuna
