// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/span_whole.hpp"

#include "engine/boundary/paper/path_search.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace lacuna::paper {
namespace {

struct UndecidedEdge {
  double weight;
  PointId low, high;  // ids
  LocalIndex a, b;

  friend bool operator<(const UndecidedEdge& x, const UndecidedEdge& y) {
    return std::tie(x.weight, x.low, x.high) < std::tie(y.weight, y.low, y.high);
  }
};

// All passed edges by vertex, in both directions. Edges that are not in the graph weigh infinitely.
class WholeGraph {
 public:
  WholeGraph(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, Scratch& scratch)
      : ids_(ids),
        scratch_(scratch),
        offsets_(scratch.array<std::uint64_t>(ids.size() + 2)),
        marks_(scratch.array<std::uint32_t>(ids.size())) {
    // Counted two places ahead, so that filling moves each offset to where its vertex ends.
    for_each_edge([&](const PassedEdge& edge) {
      scratch_.trim();
      ++offsets_[edge.a + 2];
      ++offsets_[edge.b + 2];
    });
    for (std::size_t v = 2; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
    neighbours_ = scratch.array<LocalIndex>(offsets_.back());
    weights_ = scratch.array<double>(offsets_.back());
    for_each_edge([&](const PassedEdge& edge) {
      scratch_.trim();
      const double weight = edge.is_taken ? edge.weight : kNotTaken;
      for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
        const std::uint64_t at = offsets_[from + 1]++;
        neighbours_[at] = to;
        weights_[at] = weight;
      }
    });
  }

  // Returns whether edges before this one connect its ends.
  bool connects(const UndecidedEdge& edge, std::int64_t limit) {
    const auto comes_before = [&](LocalIndex v, std::uint64_t at) {
      if (weights_[at] != edge.weight) return weights_[at] < edge.weight;
      return std::minmax(ids_[v], ids_[neighbours_[at]]) < std::minmax(edge.low, edge.high);
    };
    return search_.connects(
        edge.a, edge.b, limit, [&](LocalIndex v) -> std::uint32_t& { return marks_[v]; },
        [&](LocalIndex v, auto&& visit) {
          scratch_.trim();
          for (std::uint64_t at = offsets_[v]; at < offsets_[v + 1]; ++at) {
            if (comes_before(v, at)) visit(neighbours_[at]);
          }
        });
  }

  void take(const UndecidedEdge& edge) {
    weight_of(edge.a, edge.b) = edge.weight;
    weight_of(edge.b, edge.a) = edge.weight;
  }

  // Removes the edges that were not taken.
  SpanningGraph finish() {
    std::uint64_t begin = 0, end = 0;
    for (std::size_t v = 0; v < ids_.size(); ++v) {
      scratch_.trim();
      const std::uint64_t first = end;
      for (; begin < offsets_[v + 1]; ++begin) {
        if (weights_[begin] != kNotTaken) neighbours_[end++] = neighbours_[begin];
      }
      const auto list = neighbours_.subspan(first, end - first);
      std::sort(list.begin(), list.end(), [&](LocalIndex a, LocalIndex b) { return ids_[a] < ids_[b]; });
      offsets_[v + 1] = end;
    }
    return {ids_, offsets_.first(ids_.size() + 1), neighbours_.first(end)};
  }

 private:
  static constexpr double kNotTaken = std::numeric_limits<double>::infinity();

  double& weight_of(LocalIndex from, LocalIndex to) {
    std::uint64_t at = offsets_[from];
    while (neighbours_[at] != to) ++at;
    return weights_[at];
  }

  std::span<const PointId> ids_;
  Scratch& scratch_;
  std::span<std::uint64_t> offsets_;
  std::span<std::uint32_t> marks_;
  std::span<LocalIndex> neighbours_;
  std::span<double> weights_;
  PathSearch search_;
};

}  // namespace

// Two distinct edges close no loop of 2: e = 1 is as good as e = 2.
SpanningGraph span_whole(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, std::int64_t e,
                         std::uint64_t sort_budget, Scratch& scratch) {
  WholeGraph graph(ids, for_each_edge, scratch);
  SortedRuns<UndecidedEdge> undecided(scratch.folder() / "undecided-edges", sort_budget);
  for_each_edge([&](const PassedEdge& edge) {
    if (edge.is_taken) return;
    const auto [low, high] = std::minmax({ids[edge.a], ids[edge.b]});
    undecided.add({edge.weight, low, high, edge.a, edge.b});
  });
  const std::int64_t limit = std::max<std::int64_t>(e, 2) - 1;
  undecided.for_each([&](const UndecidedEdge& edge) {
    if (!graph.connects(edge, limit)) graph.take(edge);
  });
  return graph.finish();
}

}  // namespace lacuna::paper
