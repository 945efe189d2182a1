#include "engine/results/point_results.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace lacuna {

PointResults::PointResults(std::uint64_t ids, const TileStore& store, const Job& job)
    : store_(store),
      lists_(job.file("results"), (ids + kResultBlock - 1) / kResultBlock, job.memory.spills / 8) {}

void PointResults::take(const EvaluatedTile& tile) {
  constexpr std::size_t kTogether = 1 << 14;
  std::vector<StoredResult> results;
  const auto add = [&](PointId id, LocalIndex p) {
    const Evaluation& e = tile.evaluations[p];
    StoredResult& result = results.emplace_back(
        StoredResult{.id = id, .row = tile.points.rows[p], .probability = tile.probability(p)});
    for (std::size_t i = 0; i < kCriteria; ++i) result.criteria[i] = static_cast<float>(e.criteria[i]);
    for (int axis = 0; axis < 3; ++axis) result.normal[axis] = static_cast<float>(e.normal[axis]);
  };
  for (LocalIndex p = 0; p < tile.points.owned; ++p) add(tile.points.ids[p], p);
  // Of copies there may be more than fit in memory.
  store_.for_each_duplicate(tile.index, [&](const Duplicate& d) {
    if (results.size() >= kTogether) append(results);
    add(d.id, d.of);
  });
  append(results);
}

void PointResults::append(std::vector<StoredResult>& results) {
  std::sort(results.begin(), results.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t begin = 0, end; begin < results.size(); begin = end) {
    const std::uint64_t block = value(results[begin].id) / kResultBlock;
    for (end = begin; end < results.size() && value(results[end].id) / kResultBlock == block;) ++end;
    lists_.append(block, std::span(results).subspan(begin, end - begin));
  }
  results.clear();
}

}  // namespace lacuna
