// SPDX-License-Identifier: Apache-2.0
#include "engine/results/point_results.hpp"

#include "engine/criteria/criteria.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {
namespace {

constexpr RecordStream<std::byte> kResults{
    "results"};  // a result and its criteria, for one point after the other

}  // namespace

void emit_point_results(const EvaluatedTile& tile, TileOutput& output) {
  const std::size_t criteria_count = criteria().size();
  std::vector<std::byte> records;
  records.reserve(tile.points.owned * (sizeof(ResultHead) + criteria_count * sizeof(float)));
  const auto put = [&](const void* data, std::size_t bytes) {
    const auto* const first = static_cast<const std::byte*>(data);
    records.insert(records.end(), first, first + bytes);
  };
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    ResultHead result{.id = tile.points.ids[p], .row = {}, .probability = tile.probability(p)};
    for (int axis = 0; axis < 3; ++axis)
      result.normal[axis] = static_cast<float>(tile.evaluations[p].normal[axis]);
    put(&result, sizeof result);
    for (const double value : tile.criteria.subspan(p * criteria_count, criteria_count)) {
      const auto criterion = static_cast<float>(value);
      put(&criterion, sizeof criterion);
    }
  }
  output.add(kResults, std::move(records));
}

PointResults::PointResults(const TileOutputs& outputs, std::uint64_t ids, const TileStore& store,
                           const Spill& spill, const Workers& workers)
    : store_(store),
      criteria_(criteria().size()),
      lists_(std::make_unique<AppendBytes>(spill, "results", (ids + kResultBlock - 1) / kResultBlock)) {
  const std::vector<Tile>& tiles = store.tiling().tiles;
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiles) needs.push_back(tile.points * record_bytes());
  workers.for_each_within(workers.memory.tiles, needs,
                          [&](std::size_t t) { take(outputs, static_cast<TileIndex>(t)); });
}

void PointResults::take(const TileOutputs& outputs, TileIndex tile) {
  constexpr std::size_t kTogether = 1 << 14;
  const std::vector<std::byte> records = outputs.read(kResults, tile);
  std::vector<Duplicate> copies;  // each point of the tile, as a copy of itself, and its copies
  const auto add = [&](const Duplicate& copy) {
    if (copies.size() >= kTogether) append(tile, records, copies);  // there may be more than fit in memory
    copies.push_back(copy);
  };
  for (LocalIndex p = 0; p * record_bytes() < records.size(); ++p) {
    PointId id;
    std::memcpy(&id, &records[p * record_bytes() + offsetof(ResultHead, id)], sizeof id);
    add({id, p});
  }
  store_.for_each_duplicate(tile, add);
  append(tile, records, copies);
}

void PointResults::append(TileIndex tile, std::span<const std::byte> records,
                          std::vector<Duplicate>& copies) {
  std::sort(copies.begin(), copies.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  std::vector<std::byte> block;  // of ids
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const PointId id = copies[i].id;
    const LocalIndex p = copies[i].of;
    const auto record = records.subspan(p * record_bytes(), record_bytes());
    const std::size_t at = block.size();
    block.insert(block.end(), record.begin(), record.end());
    const Row row = store_.tiling().tiles[tile].row(p);
    std::memcpy(&block[at + offsetof(ResultHead, id)], &id, sizeof id);
    std::memcpy(&block[at + offsetof(ResultHead, row)], &row, sizeof row);
    const std::uint64_t number = value(id) / kResultBlock;
    if (i + 1 == copies.size() || value(copies[i + 1].id) / kResultBlock != number) {
      lists_->append(number, block);
      block.clear();
    }
  }
  copies.clear();
}

}  // namespace lacuna
