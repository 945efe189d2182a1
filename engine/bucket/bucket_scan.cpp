// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/bucket_scan.hpp"

#include "engine/bucket/order_tile.hpp"
#include "engine/bucket/set_aside.hpp"
#include "engine/bucket/split.hpp"
#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace lacuna {
namespace {

using Tree = openvdb::Int32Tree;
using Leaf = Tree::LeafNodeType;
using Lower = Tree::RootNodeType::ChildNodeType::ChildNodeType;

openvdb::Coord coord_of(const CellCoord& cell) {
  return {cell[0], cell[1], cell[2]};
}

const Leaf* leaf_at(const Lower* node, const openvdb::Coord& cell) {
  if (node == nullptr) return nullptr;
  const openvdb::Index at = Lower::coordToOffset(cell);
  return node->isChildMaskOn(at) ? node->getTable()[at].getChild() : nullptr;
}

constexpr std::size_t kBatches = 4;  // in flight

// The destination of the points of every cell: a tile, or, from `aside` on, a group of points that are set
// aside.
struct Destinations {
  explicit Destinations(const TilePlan& plan)
      : index(plan.grid, plan.cells, plan.heavy),
        of_cell(plan.cells.size() + plan.heavy.size()),
        aside(static_cast<std::uint32_t>(plan.tiles.size())),
        far(aside + static_cast<std::uint32_t>(plan.heavy.size())),
        end(aside + static_cast<std::uint32_t>(plan.groups())) {
    for (std::uint32_t t = 0; t < aside; ++t) {
      const Tile& tile = plan.tiles[t];
      std::fill(of_cell.begin() + tile.first_cell, of_cell.begin() + tile.last_cell, t);
    }
    std::iota(of_cell.end() - static_cast<std::ptrdiff_t>(plan.heavy.size()), of_cell.end(), aside);
  }

  // Returns `end` where no point was counted.
  std::uint32_t operator[](std::uint32_t cell) const {
    return cell == CellIndex::kNoCell ? far : of_cell[cell];
  }

  CellIndex index;
  std::vector<std::uint32_t> of_cell;
  std::uint32_t aside, far, end;
};

// The finite points of one batch, sorted by destination.
struct SortedBatch {
  PointBatch batch;
  std::vector<ScanPoint> points;
  std::vector<PlainNormal> normals;
  std::vector<std::uint32_t> ends;  // of each destination's points

  void sort(const Destinations& to);

 private:
  std::vector<std::uint32_t> destinations;  // of each point of the batch; its cell at first
};

// Sorts by counting. Points that are not finite go behind the last destination, and are then removed.
void SortedBatch::sort(const Destinations& to) {
  destinations.resize(batch.size());
  to.index.find(batch.positions, destinations);
  ends.assign(to.end + 2, 0);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t cell = destinations[i];
    const bool finite = batch.positions[i].allFinite();
    if (finite && to[cell] == to.end) fail_changed("a point lies where none was counted");
    destinations[i] = finite ? to[cell] : to.end;
    ++ends[destinations[i] + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  const std::uint32_t finite = ends[to.end];
  points.resize(batch.size());
  normals.resize(batch.normals.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t at = ends[destinations[i]]++;
    const Eigen::Vector3d p = batch.positions[i].array() + 0.0;  // -0 is 0
    points[at] = {p.x(), p.y(), p.z(), batch.id(i)};
    if (!normals.empty()) normals[at] = {batch.normals[i].x(), batch.normals[i].y(), batch.normals[i].z()};
  }
  points.resize(finite);
  normals.resize(batch.normals.empty() ? 0 : finite);
  ends.resize(to.end);
}

void append(const SortedBatch& batch, std::uint32_t places, ScatteredPoints& scattered) {
  std::uint32_t begin = 0;
  for (std::uint32_t place = 0; place < places; ++place) {
    const std::uint32_t count = batch.ends[place] - begin;
    if (count > 0) {
      scattered.add(place, std::span(batch.points).subspan(begin, count),
                    batch.normals.empty() ? std::span<const PlainNormal>()
                                          : std::span(batch.normals).subspan(begin, count));
    }
    begin += count;
  }
}

template <class Record>
std::vector<Record> pick(const std::vector<Record>& records, std::span<const std::uint32_t> order) {
  std::vector<Record> picked;
  picked.reserve(order.size());
  for (const std::uint32_t i : order) picked.push_back(records[i]);
  return picked;
}

// Returns the cells of a tile's points, counted from its first cell.
std::vector<std::uint32_t> cells_of(std::span<const ScanPoint> points, const CellIndex& index,
                                    const Tile& tile) {
  std::vector<std::uint32_t> cells(points.size());
  std::array<Eigen::Vector3d, 256> positions;
  for (std::size_t first = 0; first < points.size(); first += positions.size()) {
    const std::size_t count = std::min(positions.size(), points.size() - first);
    for (std::size_t i = 0; i < count; ++i) positions[i] = points[first + i].position();
    index.find(std::span(positions).first(count), std::span(cells).subspan(first, count));
  }
  for (std::uint32_t& cell : cells) cell -= tile.first_cell;
  return cells;
}

// Returns the least bytes of the store. Raw points of tiles are all written. Points that are set aside may be
// copies of a few.
std::uint64_t least_store_bytes(const TilePlan& plan, Precision precision) {
  std::uint64_t points = 0;
  for (const Tile& tile : plan.tiles) points += tile.raw;
  return points * (precision == Precision::kSingle ? sizeof(ScanPoint) / 2 : sizeof(ScanPoint));
}

}  // namespace

struct CellIndex::Grid {
  CellGrid cells;
  openvdb::Int32Grid::Ptr numbers = openvdb::Int32Grid::create(-1);  // as `kNoCell`
};

CellIndex::CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
                     std::span<const CountedCell> heavy)
    : grid_(std::make_unique<Grid>(Grid{grid})) {
  auto numbers = grid_->numbers->getUnsafeAccessor();
  std::int32_t number = 0;
  for (const std::span<const CountedCell> part : {cells, heavy}) {
    for (const CountedCell& cell : part) numbers.setValueOn(coord_of(cell.coord), number++);
  }
}

CellIndex::CellIndex(CellIndex&&) noexcept = default;
CellIndex::~CellIndex() = default;

// The search goes in steps through the levels of the tree, each for many positions: the cache misses of
// positions in random order overlap.
void CellIndex::find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> numbers) const {
  assert(positions.size() == numbers.size());
  constexpr std::size_t kTogether = 256;
  static constexpr std::int32_t kNone = -1;
  std::array<CellCoord, kTogether> cells;
  std::array<const Lower*, kTogether> nodes;
  std::array<const Leaf*, kTogether> leaves;
  std::array<const std::int32_t*, kTogether> values;
  const auto accessor = grid_->numbers->getConstUnsafeAccessor();
  for (std::size_t first = 0; first < positions.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, positions.size() - first);
    grid_->cells.cells_of(positions.subspan(first, count), std::span(cells).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const openvdb::Coord cell = coord_of(cells[i]);
      nodes[i] = accessor.probeConstNode<Lower>(cell);
      if (nodes[i] != nullptr) __builtin_prefetch(nodes[i]->getTable() + Lower::coordToOffset(cell));
    }
    for (std::size_t i = 0; i < count; ++i) {
      leaves[i] = leaf_at(nodes[i], coord_of(cells[i]));
      __builtin_prefetch(leaves[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = leaves[i] == nullptr ? &kNone
                                       : leaves[i]->buffer().data() + Leaf::coordToOffset(coord_of(cells[i]));
      __builtin_prefetch(values[i]);
    }
    for (std::size_t i = 0; i < count; ++i) numbers[first + i] = static_cast<std::uint32_t>(*values[i]);
  }
}

TilePlan plan_tiles(SurveyedScan& survey, const Job& job) {
  const std::uint64_t points = survey.points - survey.dropped;
  TilePlan plan = split_tiles(survey, points_per_tile(points, job.config, job.workers));
  plan.cell_points = points_per_cell(points, job.workers.memory);
  require_space(job.spill.folder, least_store_bytes(plan, survey.precision()));
  return plan;
}

ScatteredPoints scatter_points(PointSource& scan, const TilePlan& plan, Precision precision,
                               std::uint64_t expected_points, Job& job) {
  Phase phase(job.phases, "bucket", expected_points);
  const Destinations to(plan);
  ScatteredPoints scattered(to.end, {precision, scan.has_normals()}, job.spill);
  const MemoryLedger::Lease reading = job.workers.memory.ledger.take(job.workers.memory.reading);
  std::vector<SortedBatch> batches(kBatches);
  job.workers.arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                             [&](std::size_t slot) {
                               batches[slot].sort(to);
                               append(batches[slot], to.end, scattered);
                             },
                             [&](std::size_t slot) { phase.advance(batches[slot].points.size()); }, kBatches);
  return scattered;
}

TileStore store_tiles(const TilePlan& plan, const TaskShare& share, const Eigen::AlignedBox3d& bounds,
                      const PointLayout& layout,
                      const std::function<void(std::size_t, const VisitPoints&)>& for_each, StoreFiles files,
                      const Workers& workers, Phases& phases) {
  std::vector<std::uint64_t> weights;
  for (const Tile& tile : plan.tiles) weights.push_back(tile.raw);
  const IndexRange range = share_of(weights, share);
  const std::span<const Tile> mine = std::span(plan.tiles).subspan(range.first, range.last - range.first);
  const std::filesystem::path aside_file = files.spill.file("aside");
  const std::uint64_t most_tiles = plan.most_tiles() - plan.tiles.size() + mine.size();
  StoreWriter store(std::move(files), most_tiles, layout.precision, layout.with_normals);
  std::vector<std::uint64_t> needs;
  std::uint64_t points = 0;
  for (const Tile& tile : mine) {
    store.reserve(tile.raw);
    needs.push_back(tile.raw * 120);
    points += tile.raw;
  }
  Phase phase(phases, "order", points);
  const std::uint32_t first_cell = mine.empty() ? 0 : mine.front().first_cell;
  const std::uint32_t last_cell = mine.empty() ? 0 : mine.back().last_cell;
  const CellIndex index(plan.grid, std::span(plan.cells).subspan(first_cell, last_cell - first_cell));
  workers.for_each_within(workers.memory.tiles, needs, [&](std::size_t t) {
    PointsAndNormals raw;
    raw.points.reserve(mine[t].raw);
    for_each(range.first + t, [&](const PointsAndNormals& some) {
      raw.points.insert(raw.points.end(), some.points.begin(), some.points.end());
      raw.normals.insert(raw.normals.end(), some.normals.begin(), some.normals.end());
    });
    if (raw.points.size() != mine[t].raw) fail_changed("not the points that were counted");
    Tile cells = mine[t];
    cells.first_cell -= first_cell;
    cells.last_cell -= first_cell;
    const auto tile = static_cast<TileIndex>(t);
    OrderedTile ordered = order_tile(raw.points, cells_of(raw.points, index, cells),
                                     cells.last_cell - cells.first_cell, plan.grid, plan.cell_points);
    store.put(tile, pick(raw.points, ordered.order),
              layout.with_normals ? pick(raw.normals, ordered.order) : raw.normals, std::move(ordered.cells));
    store.add_duplicates(tile, ordered.duplicates);
    phase.advance(raw.points.size());
  });
  if (share.task + 1 == share.tasks && plan.groups() > 0) {
    const MemoryLedger::Lease sorting = workers.memory.ledger.take(workers.memory.work / 2);
    SetAside aside(plan, bounds, aside_file, sorting.bytes());
    for (std::uint32_t group = 0; group < plan.groups(); ++group) {
      for_each(plan.tiles.size() + group, [&](const PointsAndNormals& some) {
        for (std::size_t i = 0; i < some.points.size(); ++i)
          aside.add(group, some.points[i], some.normals.empty() ? PlainNormal{} : some.normals[i]);
      });
    }
    aside.store(store, plan.cell_points);
  }
  return store.finish();
}

}  // namespace lacuna
