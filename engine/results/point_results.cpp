#include "engine/results/point_results.hpp"

#include "engine/criteria/criteria.hpp"

#include <algorithm>

namespace lacuna {

PointResults::PointResults(std::uint64_t ids, const TileStore& store, const Job& job)
    : store_(store),
      criteria_(criteria().size()),
      lists_(job.file("results"), (ids + kResultBlock - 1) / kResultBlock, job.memory.spills / 8) {}

void PointResults::take(const EvaluatedTile& tile) {
  constexpr std::size_t kTogether = 1 << 14;
  std::vector<Duplicate> results;  // each point of the tile, as a copy of itself, and its copies
  for (LocalIndex p = 0; p < tile.points.owned; ++p) results.push_back({tile.points.ids[p], p});
  // There may be more copies than fit in memory.
  store_.for_each_duplicate(tile.index, [&](const Duplicate& d) {
    if (results.size() >= kTogether) append(tile, results);
    results.push_back(d);
  });
  append(tile, results);
}

void PointResults::append(const EvaluatedTile& tile, std::vector<Duplicate>& results) {
  std::sort(results.begin(), results.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  std::vector<std::byte> records;
  const auto put = [&](const void* data, std::size_t bytes) {
    const auto* const first = static_cast<const std::byte*>(data);
    records.insert(records.end(), first, first + bytes);
  };
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto [id, p] = results[i];
    StoredResult result{.id = id, .row = tile.points.rows[p], .probability = tile.probability(p)};
    for (int axis = 0; axis < 3; ++axis)
      result.normal[axis] = static_cast<float>(tile.evaluations[p].normal[axis]);
    put(&result, sizeof result);
    for (const double value : tile.criteria.subspan(p * criteria_, criteria_)) {
      const auto criterion = static_cast<float>(value);
      put(&criterion, sizeof criterion);
    }
    const std::uint64_t block = value(id) / kResultBlock;
    if (i + 1 == results.size() || value(results[i + 1].id) / kResultBlock != block) {
      lists_.append(block, records);
      records.clear();
    }
  }
  results.clear();
}

}  // namespace lacuna
