// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/survey.hpp"

#include "engine/run/error.hpp"
#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// Beyond these the powers of two, or their squares, would leave the range of double.
constexpr int kMinExponent = -500;
constexpr int kMaxExponent = 500;

// A scan of an unknown number of points counts as this many: cells are rather too fine than too coarse.
constexpr std::uint64_t kUnknownPoints = 1 << 24;

// A survey takes at most this much memory, even where more is allowed. Surfaces need no more. Where points
// lie apart, passes over their many small cells would take most of the time.
constexpr std::uint64_t kFewBytes = std::uint64_t{32} << 20, kBytesPerPoint = 8;

// The table has space for so many cells in any case.
constexpr std::uint64_t kFewestCells = 2048;

// A cell's share of the index and the tree built from it.
constexpr std::uint64_t kBytesPerCell = 96;

// Cells that do not merge within so many doublings are apart from each other. A first batch of 64 Ki points
// that is one part in 4^8 of a scan has cells that much too fine.
constexpr int kDoublingsAhead = 8;

// Regions of 128^3 cells.
constexpr int kRegionDoublings = 7;

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

// Returns whether most cells did not merge when the size doubled. A surface keeps a quarter of them, a line
// keeps half. Below `kEnough` cells nothing follows.
bool are_sparse(std::uint64_t before, std::uint64_t after) {
  constexpr std::uint64_t kEnough = 64;
  return before >= kEnough && 4 * after > 3 * before;
}

// A region with fewer points is far from the others. A surface that passes through a region has hundreds of
// thousands of points there.
std::uint64_t few_points(std::uint64_t points) {
  return std::min<std::uint64_t>(256, points / 1024);
}

void refuse_beyond(const PointBatch& batch) {
  const auto found = std::find_if(batch.positions.begin(), batch.positions.end(), is_too_far);
  if (found == batch.positions.end()) return;
  std::ostringstream message;
  message << "point " << value(batch.id(static_cast<std::size_t>(found - batch.positions.begin())))
          << " lies at " << found->transpose() << "; coordinates must be within 1e30";
  throw Error(message.str());
}

CellCoord shifted(const CellCoord& cell, int doublings) {
  return {cell[0] >> doublings, cell[1] >> doublings, cell[2] >> doublings};
}

// Returns the bytes of OpenVDB's nodes above cells that come along a Z curve.
std::uint64_t node_bytes(std::span<const CountedCell> cells) {
  using Upper = openvdb::Int32Tree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  using Leaf = Lower::ChildNodeType;
  std::uint64_t bytes = 0;
  const CountedCell* before = nullptr;
  for (const CountedCell& cell : cells) {
    const int joined = before == nullptr ? INT_MAX : doublings_to_join(before->coord, cell.coord);
    if (joined > int{Leaf::TOTAL}) bytes += sizeof(Leaf) + Leaf::SIZE * sizeof(std::int32_t);
    if (joined > int{Lower::TOTAL}) bytes += sizeof(Lower);
    if (joined > int{Upper::TOTAL}) bytes += sizeof(Upper);
    before = &cell;
  }
  return bytes;
}

constexpr std::size_t kBatches = 4;  // in flight

// Counts the points of a pass that has begun.
void count_points(Survey& survey, PointSource& scan, std::uint64_t expected, const TaskArena& arena,
                  Phases& phases) {
  Phase phase(phases, "survey", expected);
  struct Counted {
    PointBatch batch;
    std::optional<CellCounts> counts;  // none while the cell size is not known
  };
  std::vector<Counted> batches(kBatches);
  arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                 [&](std::size_t slot) {
                   Counted& counted = batches[slot];
                   counted.counts.reset();
                   if (survey.is_sized()) counted.counts = count_cells(counted.batch, survey.finest());
                 },
                 [&](std::size_t slot) {
                   const Counted& counted = batches[slot];
                   counted.counts ? survey.add(*counted.counts) : survey.add(counted.batch);
                   phase.advance(counted.batch.size());
                 },
                 kBatches);
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
      if (counts.runs.empty() || !same_cell(counts.runs.back().coord, cells[i]))
        counts.runs.push_back({cells[i], 0});
      ++counts.runs.back().points;
    }
  }
  if (!counts.bounds.isEmpty() && (is_too_far(counts.bounds.min()) || is_too_far(counts.bounds.max())))
    refuse_beyond(batch);
  return counts;
}

Survey::Survey(std::uint64_t memory, std::uint64_t expected_points, std::filesystem::path file)
    : expected_points_(expected_points > 0 ? expected_points : kUnknownPoints),
      memory_(std::min(memory, kFewBytes + kBytesPerPoint * expected_points_)),
      stored_(std::move(file), memory_ / 4) {}

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

  // Cells grow by the factor by which the batch is thinner than the scan. Those of outliers are alone in a
  // block of 8^3 cells.
  const int doublings = std::ilogb(std::max(points / static_cast<double>(batch.size()), 1.0)) / 2;
  const std::vector<CountedCell> runs = count_cells(batch, scan_.grid).runs;
  CellTable sample, blocks;
  sample.add(runs, doublings);
  blocks.add(runs, doublings + 3);
  std::size_t together = sample.size();
  blocks.for_each([&](const CountedCell& block) { together -= block.points == 1; });
  const double most = 2 * points / kPointsPerCell;
  for (double cells = std::ldexp(static_cast<double>(together), 2 * doublings); cells > most; cells /= 4)
    ++finest;
  scan_.grid = CellGrid::around(place.middle, finest);
  sized_ = true;
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
  add_runs(counts.runs);
}

void Survey::add_runs(std::span<const CountedCell> runs) {
  constexpr std::size_t kTogether = 256;
  for (; !runs.empty(); runs = runs.subspan(std::min(runs.size(), kTogether))) {
    table_.add(runs.first(std::min(runs.size(), kTogether)), scan_.grid.shift);
    if (is_full()) make_space();
  }
}

// The table takes half of the memory. More than twice the wanted number of cells only takes time.
bool Survey::is_full() const {
  const std::uint64_t wanted = std::max(scan_.points, expected_points_) / kPointsPerCell;
  return table_.size() > std::min(memory_ / 2 / CellTable::kBytesPerCell, std::max(2 * wanted, kFewestCells));
}

// Where the first batch is a small part of the scan, cells may be far finer than the spacing of the points.
// One doubling merges none of them then.
void Survey::make_space() {
  const auto is_sparse = [&](const CellTable& larger) { return are_sparse(table_.size(), larger.size()); };
  int& shift = scan_.grid.shift;
  const int most = std::min(shift + kDoublingsAhead, CellGrid::kMaxShift);
  if (shift == most || is_sparse(table_.merged(most))) return store_cells();
  CellTable larger;
  do larger = table_.merged(++shift);
  while (is_sparse(larger));
  table_ = std::move(larger);
}

void Survey::store_cells() {
  table_.for_each([&](const CountedCell& cell) { stored_.add(cell); });
  table_ = CellTable();
}

// Returns the number of cells of each size from the finest on.
std::vector<std::uint64_t> Survey::count_by_shift() {
  std::vector<std::uint64_t> counts(CellGrid::kMaxShift + 1, 0);
  std::optional<CellCoord> before;
  stored_.for_each([&](const CountedCell& cell) {
    const int joined = before ? doublings_to_join(*before, cell.coord) : CellGrid::kMaxShift + 1;
    if (joined > 0) ++counts[static_cast<std::size_t>(std::min(joined - 1, CellGrid::kMaxShift))];
    before = cell.coord;
  });
  for (std::size_t shift = counts.size() - 1; shift-- > 0;) counts[shift] += counts[shift + 1];
  return counts;
}

// Collects the cells of the grid's size, with all of their points. Cells in regions of fewer than `few`
// points, and unbounded ones, are far; without `few`, no cell is. Ends early with more than `most` cells.
void Survey::collect_cells(std::optional<std::uint64_t> few, std::uint64_t most) {
  std::vector<CountedCell>& cells = scan_.cells;
  cells.clear();
  scan_.far_points = 0;
  std::size_t first = 0;  // cell of the region
  std::uint64_t region_points = 0;
  const auto end_region = [&] {
    if (few && region_points < *few) {
      scan_.far_points += region_points;
      cells.resize(first);
    }
    first = cells.size();
    region_points = 0;
  };
  stored_.for_each([&](const CountedCell& stored) {
    if (cells.size() > most) return;
    const CellCoord cell = shifted(stored.coord, scan_.grid.shift);
    if (few && scan_.grid.is_unbounded(cell)) {
      scan_.far_points += stored.points;
      return;
    }
    const int joined = cells.size() > first ? doublings_to_join(cells.back().coord, cell) : 0;
    if (joined > kRegionDoublings) end_region();
    if (cells.size() == first || joined > 0) cells.push_back({cell, 0});
    std::uint32_t& points = cells.back().points;
    points = static_cast<std::uint32_t>(std::min(std::uint64_t{points} + stored.points, kMostCounted));
    region_points += stored.points;
  });
  end_region();
}

bool Survey::does_index_fit() const {
  return node_bytes(scan_.cells) + scan_.cells.size() * kBytesPerCell <= memory_;
}

SurveyedScan Survey::counts() {
  store_cells();
  const std::vector<std::uint64_t> cells = count_by_shift();
  int& shift = scan_.grid.shift;
  while (cells[static_cast<std::size_t>(shift)] * sizeof(CountedCell) > memory_ &&
         shift < CellGrid::kMaxShift)
    ++shift;
  collect_cells(std::nullopt, UINT64_MAX);
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
  scan_.grid.shift = std::max(scan_.grid.shift, counts.grid.shift);
  for (const CountedCell& cell : counts.cells) {
    CountedCell finest = cell;
    for (std::int32_t& coordinate : finest.coord) coordinate <<= counts.grid.shift;
    add_runs({&finest, 1});
  }
}

SurveyedScan Survey::finish() {
  store_cells();
  const std::vector<std::uint64_t> cells = count_by_shift();
  const std::uint64_t points = scan_.points - scan_.dropped;
  int& shift = scan_.grid.shift;
  for (; shift < CellGrid::kMaxShift; ++shift) {
    const std::uint64_t now = cells[static_cast<std::size_t>(shift)],
                        doubled = cells[static_cast<std::size_t>(shift) + 1];
    if (points >= kPointsPerCell * now || now <= 1 || are_sparse(now, doubled)) break;
  }
  const std::uint64_t few = few_points(points);
  const auto collect = [&](std::uint64_t most) { collect_cells(few, most + few); };
  for (collect(memory_ / kBytesPerCell); !does_index_fit() && shift < CellGrid::kMaxShift;) {
    ++shift;
    collect(shift < CellGrid::kMaxShift ? memory_ / kBytesPerCell : UINT64_MAX - few);
  }
  return std::move(scan_);
}

SurveyedScan survey_scan(PointSource& scan, Job& job) {
  const std::uint64_t expected = scan.expected_points().value_or(0);
  const MemoryLedger::Lease reading = job.workers.memory.ledger.take(job.workers.memory.reading);
  Survey survey(job.workers.memory.cells, expected, job.spill.file("cells"));
  scan.rewind();
  count_points(survey, scan, expected, job.workers.arena, job.phases);
  if (!survey.is_sized()) scan.refuse_empty();
  return survey.finish();
}

SurveyedScan survey_parts(PointSource& scan, const IndexRange& parts, Job& job) {
  const MemoryLedger::Lease reading = job.workers.memory.ledger.take(job.workers.memory.reading);
  Survey survey(job.workers.memory.cells, scan.expected_points().value_or(0), job.spill.file("cells"));
  // All tasks count from one size on: the size for the first points of the scan.
  scan.rewind();
  for (PointBatch batch; !survey.is_sized() && scan.next(batch);) survey.choose_size(batch);
  if (!survey.is_sized()) scan.refuse_empty();
  scan.rewind_to(parts, PointId{0});
  count_points(survey, scan, 0, job.workers.arena, job.phases);
  return survey.counts();
}

SurveyedScan merge_surveys(std::size_t tasks, const std::function<SurveyedScan(std::size_t)>& survey_of_task,
                           std::optional<std::uint64_t> expected_points, const Spill& spill,
                           const Memory& memory) {
  Survey survey(memory.cells, expected_points.value_or(0), spill.file("cells"));
  for (std::size_t task = 0; task < tasks; ++task) survey.add(survey_of_task(task));
  return survey.finish();
}

}  // namespace lacuna
