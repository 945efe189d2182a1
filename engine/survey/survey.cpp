// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/survey.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// Beyond these the powers of two, or their squares, would leave the range of double.
constexpr int kMinExponent = -500;
constexpr int kMaxExponent = 500;

// A scan of an unknown number of points counts as this many: cells are rather too fine than too coarse.
constexpr std::uint64_t kUnknownPoints = 1 << 24;

// Counts take at most this much memory, even where more is allowed. The cells of surfaces take 12 bytes for
// each point at most. Where outliers or clusters need more, passes over their many small cells would take
// most of the time.
constexpr std::uint64_t kFewBytes = std::uint64_t{32} << 20, kBytesPerPoint = 8;

// A cell's share of the index and the tree built from it.
constexpr std::uint64_t kBytesPerCell = 96;

bool finite(const Eigen::Vector3d& p) {
  return p.allFinite();
}

// The place and the extent of most points.
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

constexpr std::size_t kMostRuns = 256;

// Calls visit(some) with the runs that are counted at a time.
template <class Visit>
void for_each_part(std::span<const CellRun> runs, Visit&& visit) {
  for (; !runs.empty(); runs = runs.subspan(std::min(runs.size(), kMostRuns)))
    visit(runs.first(std::min(runs.size(), kMostRuns)));
}

// Returns whether most cells, or leaves, did not merge when the size doubled. A surface keeps a quarter of
// them, a line keeps half. Below `kEnough` cells nothing follows.
bool are_sparse(std::uint64_t before, std::uint64_t after) {
  constexpr std::uint64_t kEnough = 64;
  return before >= kEnough && 4 * after > 3 * before;
}

// A region of 128^3 cells with fewer points is far from the others. A surface that passes through a region
// has hundreds of thousands of points there.
std::uint64_t few_points(std::uint64_t points) {
  return std::min<std::uint64_t>(256, points / 1024);
}

void refuse_beyond(const PointBatch& batch) {
  const auto found = std::find_if(batch.positions.begin(), batch.positions.end(), is_too_far);
  if (found == batch.positions.end()) return;
  std::ostringstream message;
  message << "point " << value(batch.id(static_cast<std::size_t>(found - batch.positions.begin())))
          << " lies at " << found->transpose() << "; coordinates must be within 1e153";
  throw Error(message.str());
}

}  // namespace

Precision SurveyTotals::precision() const {
  constexpr std::uint64_t kIds = std::uint64_t{1} << 32;
  return is_single && ids <= kIds ? Precision::kSingle : Precision::kDouble;
}

CellCounts count_cells(const PointBatch& batch, const CellGrid& grid) {
  CellCounts counts{.points = batch.size()};
  if (batch.size() > 0) counts.ids = value(batch.id(batch.size() - 1)) + 1;
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
  if (!counts.bounds.isEmpty() && (is_too_far(counts.bounds.min()) || is_too_far(counts.bounds.max())))
    refuse_beyond(batch);
  return counts;
}

Survey::Survey(std::uint64_t memory, std::uint64_t expected_points)
    : memory_(std::min(
          memory, kFewBytes + kBytesPerPoint * (expected_points > 0 ? expected_points : kUnknownPoints))),
      is_expected_(expected_points > 0),
      expected_points_(is_expected_ ? expected_points : kUnknownPoints) {}

// A surface of n points and this extent has sqrt(n / 16) cells of 16 points along it. Half of that size is
// small enough for a first batch from a small area of the scan. A batch that is spread over the whole scan,
// in random order, shows how many cells there will be. Sizes with several times too many are then passed
// over.
void Survey::choose_cell_size(const PointBatch& batch) {
  const double points = static_cast<double>(expected_points_);
  const Whereabouts place = whereabouts_of(batch);
  const double farthest = place.middle.cwiseAbs().maxCoeff();
  double extent = place.extent;
  if (extent == 0) extent = place.farthest > 0 ? place.farthest : 1;  // most points at one place
  const double edge = extent / (2 * std::sqrt(points / kPointsPerCell) + 1);
  // Cells below the last digit of the coordinates would divide nothing.
  const int digit = farthest > 0 ? std::ilogb(farthest) - std::numeric_limits<double>::digits : kMinExponent;
  int finest = std::clamp(std::ilogb(std::max(edge, 1e-300)), std::max(digit, kMinExponent), kMaxExponent);
  scan_.grid = CellGrid::around(place.middle, finest);

  // Cells grow by the factor by which the batch is thinner than the scan, and again by the number of their
  // parts.
  const double thinner = std::max(points / static_cast<double>(batch.size()), 1.0);
  int doublings = std::ilogb(thinner) / 2;
  const std::vector<CellRun> runs = count_cells(batch, scan_.grid).runs;
  CellTree sample;
  const auto count = [&] {
    sample = CellTree();
    for (std::span<const CellRun> rest = runs; !rest.empty();
         rest = rest.subspan(std::min(rest.size(), kMostRuns))) {
      if (sample.bytes() > memory_) return false;
      sample.add(rest.first(std::min(rest.size(), kMostRuns)), doublings);
    }
    return true;
  };
  while (!count() && doublings < CellGrid::kMaxShift) ++doublings;
  const double most = 2 * points / kPointsPerCell;
  for (double cells = std::ldexp(static_cast<double>(sample.cells_with_neighbours()), 2 * doublings);
       cells > most; cells /= 4)
    ++finest;
  scan_.grid = CellGrid::around(place.middle, finest);
  sized_ = true;
}

void Survey::double_cell_size(CellTree merged) {
  counts_ = std::move(merged);
  ++scan_.grid.shift;
}

// Merges cells of the tree, unless most of the things that `count(tree)` counts would not merge.
template <class Count>
bool Survey::merge_if_dense(Count&& count) {
  CellTree merged = counts_.merged();
  if (are_sparse(count(counts_), count(merged))) return false;
  double_cell_size(std::move(merged));
  return true;
}

void Survey::choose_size(const PointBatch& batch) {
  if (!sized_ && std::any_of(batch.positions.begin(), batch.positions.end(), finite)) choose_cell_size(batch);
}

void Survey::add(const PointBatch& batch) {
  choose_size(batch);
  add(count_cells(batch, finest()));
}

void Survey::add(const CellCounts& counts) {
  scan_.points += counts.points;
  scan_.dropped += counts.dropped;
  scan_.ids = std::max(scan_.ids, counts.ids);
  scan_.bounds.extend(counts.bounds);
  scan_.is_single &= counts.is_single;
  add_runs(counts.runs, 0);
}

// `shift`: of the cells of the runs.
void Survey::add_runs(std::span<const CellRun> all, int shift) {
  for_each_part(all, [&](std::span<const CellRun> runs) {
    counts_.add(runs, scan_.grid.shift - shift);
    while (needs_too_much() && can_merge()) double_cell_size(counts_.merged());
    while (is_too_fine() && can_merge()) {
      // It counts leaves: in random order cells have few points at first, and hardly merge.
      if (merge_if_dense([](const CellTree& counts) { return counts.leaves(); })) continue;
      apart_ = counts_.leaves();
      break;
    }
  });
}

bool Survey::needs_too_much() const {
  return counts_.bytes() + counts_.cells() * kBytesPerCell > memory_;
}

bool Survey::is_too_fine() const {
  if (counts_.leaves() <= 2 * apart_) return false;
  // Even if all points to come lie in the same cells, the cells hold too few in the end. A scan of an unknown
  // number of points may have more than its cells were made for.
  const std::uint64_t points = std::max(scan_.points, is_expected_ ? expected_points_ : 4 * expected_points_);
  // In random order, points touch leaves before they fill the cells. A surface fills about 50 cells of each
  // leaf that it passes through.
  constexpr std::uint64_t kSurelyFilled = 24;
  const std::uint64_t most = std::max<std::uint64_t>(points / kPointsPerCell, 1024);
  return counts_.cells() > most || counts_.leaves() * kSurelyFilled > most;
}

SurveyedScan Survey::counts() {
  scan_.cells = counts_.counted_cells(0);
  return std::move(scan_);
}

void Survey::add(const SurveyedScan& counts) {
  scan_.points += counts.points;
  scan_.dropped += counts.dropped;
  scan_.ids += counts.ids;
  scan_.bounds.extend(counts.bounds);
  scan_.is_single &= counts.is_single;
  if (counts.cells.empty()) return;
  if (!sized_) {
    scan_.grid = counts.grid;
    sized_ = true;
  }
  while (scan_.grid.shift < counts.grid.shift) double_cell_size(counts_.merged());
  std::vector<CellRun> runs;
  runs.reserve(counts.cells.size());
  for (const CountedCell& cell : counts.cells)
    runs.push_back({cell.coord, static_cast<std::int32_t>(cell.points)});
  add_runs(runs, counts.grid.shift);
}

SurveyedScan Survey::finish() {
  const std::uint64_t finite_points = scan_.points - scan_.dropped;
  while (finite_points < kPointsPerCell * counts_.cells() && counts_.cells() > 1 && can_merge() &&
         merge_if_dense([](const CellTree& counts) { return counts.cells(); })) {
  }
  const std::uint64_t few = few_points(finite_points);
  while (counts_.standard_bytes(few) + counts_.cells() * kBytesPerCell > memory_ && can_merge())
    double_cell_size(counts_.merged());
  scan_.cells = counts_.counted_cells(few);
  for (CountedCell& cell : scan_.cells) cell.is_far |= scan_.grid.is_unbounded(cell.coord);
  return std::move(scan_);
}

}  // namespace lacuna
