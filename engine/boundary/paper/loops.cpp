// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/loops.hpp"

#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <vector>

namespace lacuna::paper {
namespace {

// A search starts here; in ascending id.
struct Origin {
  PointId id;
  LocalIndex vertex;

  friend bool operator<(const Origin& a, const Origin& b) { return a.id < b.id; }
};

class Search {
 public:
  Search(const SpanningGraph& graph, Scratch& scratch)
      : graph_(graph),
        scratch_(scratch),
        reached_(scratch.array<Reached>(graph.size())),
        queue_(scratch.array<LocalIndex>(graph.size())) {}

  bool is_on_loop(LocalIndex v) const { return reached_[v].is_on_loop != 0; }

  // Returns the loop through the origin, and an empty loop where there is none.
  std::span<const LocalIndex> loop_through(LocalIndex origin) {
    ++stamp_;
    loop_.clear();
    reached_[origin].stamp = stamp_;
    std::size_t tail = 0;
    queue_[tail++] = origin;
    for (std::size_t head = 0; head < tail; ++head) {
      scratch_.trim();
      const LocalIndex v = queue_[head];
      for (const LocalIndex w : graph_[v]) {
        Reached& there = reached_[w];
        if (there.stamp != stamp_) {
          there = {stamp_, v, v == origin ? w : reached_[v].branch, there.is_on_loop};
          queue_[tail++] = w;
        } else if (v != origin && w != origin && reached_[v].branch != there.branch) {
          trace(origin, v, w);
          for (const LocalIndex on_loop : loop_) reached_[on_loop].is_on_loop = 1;
          return loop_;
        }
      }
    }
    return loop_;
  }

 private:
  struct Reached {
    LocalIndex stamp;  // of the search
    LocalIndex parent, branch;
    LocalIndex is_on_loop;
  };

  // The loop goes from the origin down to v, then from w back up. It is turned to the canonical start and
  // direction.
  void trace(LocalIndex origin, LocalIndex v, LocalIndex w) {
    for (LocalIndex at = v; at != origin; at = reached_[at].parent) loop_.push_back(at);
    loop_.push_back(origin);
    std::reverse(loop_.begin(), loop_.end());
    for (LocalIndex at = w; at != origin; at = reached_[at].parent) loop_.push_back(at);
    const auto lower_id = [&](LocalIndex a, LocalIndex b) { return graph_.ids[a] < graph_.ids[b]; };
    std::rotate(loop_.begin(), std::min_element(loop_.begin(), loop_.end(), lower_id), loop_.end());
    if (lower_id(loop_.back(), loop_[1])) std::reverse(loop_.begin() + 1, loop_.end());
  }

  const SpanningGraph& graph_;
  Scratch& scratch_;
  std::span<Reached> reached_;
  std::span<LocalIndex> queue_;  // as long as the component, at worst
  LocalIndex stamp_ = 0;
  std::vector<LocalIndex> loop_;
};

}  // namespace

void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report) {
  if (graph.indices.empty()) return;
  SortedRuns<Origin> origins(scratch.folder() / "origins", scratch.budget() / 8);
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.trim();
    if (!graph[v].empty()) origins.add({graph.ids[v], v});
  }
  Search search(graph, scratch);
  origins.for_each([&](const Origin& origin) {
    if (search.is_on_loop(origin.vertex)) return;
    const std::span<const LocalIndex> loop = search.loop_through(origin.vertex);
    if (!loop.empty()) report(loop);
  });
}

}  // namespace lacuna::paper
