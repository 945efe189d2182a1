// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/bucket_scan.hpp"

#include "engine/bucket/cell_index.hpp"
#include "engine/bucket/order_tile.hpp"
#include "engine/bucket/set_aside.hpp"
#include "engine/run/disk_space.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

// The destination of the points of every cell: a tile, or, from `aside` on, a group of points that are set
// aside.
struct Destinations {
  explicit Destinations(const TilePlan& plan)
      : index(plan.grid, plan.cells, std::span(plan.aside).first(plan.heavy)),
        of_cell(plan.cells.size() + plan.heavy),
        aside(static_cast<std::uint32_t>(plan.tiles.size())),
        far(aside + static_cast<std::uint32_t>(plan.heavy)),
        end(aside + static_cast<std::uint32_t>(plan.groups())) {
    for (std::uint32_t t = 0; t < aside; ++t) {
      const Tile& tile = plan.tiles[t];
      std::fill(of_cell.begin() + tile.first_cell, of_cell.begin() + tile.last_cell, t);
    }
    std::iota(of_cell.end() - static_cast<std::ptrdiff_t>(plan.heavy), of_cell.end(), aside);
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
struct Scattered {
  PointBatch batch;
  std::vector<StoredPoint> points;
  std::vector<StoredNormal> normals;
  std::vector<std::uint32_t> ends;  // of each destination's points

  void scatter(const Destinations& to);

 private:
  std::vector<std::uint32_t> destinations;  // of each point of the batch; its cell at first
};

// Sorts by counting. Points that are not finite go behind the last destination, and are then removed.
void Scattered::scatter(const Destinations& to) {
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

void append(const Scattered& batch, std::uint32_t tiles, TileStore::Filler& filler) {
  std::uint32_t begin = 0;
  for (TileIndex tile = 0; tile < tiles; ++tile) {
    const std::uint32_t count = batch.ends[tile] - begin;
    if (count > 0) {
      filler.append(tile, std::span(batch.points).subspan(begin, count),
                    batch.normals.empty() ? std::span<const StoredNormal>()
                                          : std::span(batch.normals).subspan(begin, count));
    }
    begin += count;
  }
}

void set_aside(const Scattered& batch, const Destinations& to, SetAside& aside) {
  std::uint32_t at = to.aside == 0 ? 0 : batch.ends[to.aside - 1];
  for (std::uint32_t group = to.aside; group < to.end; ++group) {
    for (; at < batch.ends[group]; ++at)
      aside.add(group - to.aside, batch.points[at],
                batch.normals.empty() ? StoredNormal{} : batch.normals[at]);
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
std::vector<std::uint32_t> cells_of(std::span<const StoredPoint> points, const CellIndex& index,
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

// Streams the scan: every finite point goes into its tile, or is set aside.
void fill(TileStore& store, SetAside& aside, PointSource& scan, const Destinations& to, Job& job,
          Phase& phase) {
  const MemoryLedger::Lease reading = job.ledger.take(job.memory.reading);
  const MemoryLedger::Lease filling = job.ledger.take((job.memory.work - job.memory.reading) / 2);
  TileStore::Filler filler(store, filling.bytes());
  std::vector<Scattered> batches(kBatches);
  scan.rewind();
  job.arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                     [&](std::size_t slot) {
                       batches[slot].scatter(to);
                       append(batches[slot], to.aside, filler);
                     },
                     [&](std::size_t slot) {
                       set_aside(batches[slot], to, aside);
                       phase.advance(batches[slot].points.size());
                     },
                     kBatches);
  filler.finish();
}

// Returns the least bytes of the store. Raw points of tiles are all written. Points that are set aside may be
// copies of a few.
std::uint64_t least_store_bytes(const TilePlan& plan, Precision precision) {
  std::uint64_t points = 0;
  for (const Tile& tile : plan.tiles) points += tile.raw;
  return points * (precision == Precision::kSingle ? sizeof(StoredPoint) / 2 : sizeof(StoredPoint));
}

}  // namespace

TilePlan plan_tiles(SurveyedScan& survey, const Job& job) {
  const std::uint64_t points = survey.points - survey.dropped;
  TilePlan plan = split_tiles(std::move(survey.cells), survey.grid, points, job.tile_points(points));
  plan.cell_points = job.cell_points(points);
  require_space(job.workspace, least_store_bytes(plan, survey.precision()));
  return plan;
}

TileStore bucket_scan(PointSource& scan, TilePlan plan, const Eigen::AlignedBox3d& bounds,
                      Precision precision, StoreFiles files, Job& job) {
  std::uint64_t points = 0;
  for (const CountedCell& cell : plan.cells) points += cell.points;
  for (const CountedCell& cell : plan.aside) points += cell.points;
  Phase phase(job, "bucket", 2 * points);
  TileStore store(std::move(files), plan.tiles, plan.most_tiles(), precision, scan.has_normals(), job.lists);
  const MemoryLedger::Lease sorting = job.ledger.take((job.memory.work - job.memory.reading) / 2);
  SetAside aside(plan, bounds, job.file("aside"), sorting.bytes());
  Destinations to(plan);
  fill(store, aside, scan, to, job, phase);
  aside.store(store, plan.cell_points);

  std::vector<std::uint64_t> needs;
  for (const Tile& tile : plan.tiles) needs.push_back(tile.raw * 120);
  job.for_each_within(job.memory.tiles, needs, [&](std::size_t t) {
    const auto number = static_cast<TileIndex>(t);
    const Tile& tile = plan.tiles[t];
    const std::vector<StoredPoint> raw = store.raw_points(number);
    const std::vector<StoredNormal> normals = store.raw_normals(number);
    OrderedTile ordered = order_tile(raw, cells_of(raw, to.index, tile), tile.last_cell - tile.first_cell,
                                     plan.grid, plan.cell_points);
    store.put(number, pick(raw, ordered.order), store.has_normals() ? pick(normals, ordered.order) : normals,
              std::move(ordered.cells));
    store.add_duplicates(number, ordered.duplicates);
    phase.advance(raw.size());
  });
  store.finish();
  return store;
}

}  // namespace lacuna
