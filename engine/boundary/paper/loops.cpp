#include "engine/boundary/paper/loops.hpp"

#include "engine/boundary/paper/cycles.hpp"
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
        seen_(scratch.array<LocalIndex>(graph.size())),
        parent_(scratch.array<LocalIndex>(graph.size())),
        branch_(scratch.array<LocalIndex>(graph.size())),
        queue_(scratch.array<LocalIndex>(graph.size())) {}

  // The loop through the origin; empty where there is none.
  std::span<const LocalIndex> loop_through(LocalIndex origin) {
    ++stamp_;
    loop_.clear();
    std::size_t head = 0, tail = 0;
    seen_[origin] = stamp_;
    queue_[tail++] = origin;
    while (head < tail) {
      scratch_.trim();
      const LocalIndex v = queue_[head++];
      for (const LocalIndex w : graph_[v]) {
        if (seen_[w] != stamp_) {
          seen_[w] = stamp_;
          parent_[w] = v;
          branch_[w] = v == origin ? w : branch_[v];
          queue_[tail++] = w;
        } else if (v != origin && w != origin && branch_[v] != branch_[w]) {
          trace(origin, v, w);
          return loop_;
        }
      }
    }
    return loop_;
  }

 private:
  // From the origin down to v, then from w back up; turned to the canonical start and direction.
  void trace(LocalIndex origin, LocalIndex v, LocalIndex w) {
    for (LocalIndex at = v; at != origin; at = parent_[at]) loop_.push_back(at);
    loop_.push_back(origin);
    std::reverse(loop_.begin(), loop_.end());
    for (LocalIndex at = w; at != origin; at = parent_[at]) loop_.push_back(at);
    const auto lower_id = [&](LocalIndex a, LocalIndex b) { return graph_.ids[a] < graph_.ids[b]; };
    std::rotate(loop_.begin(), std::min_element(loop_.begin(), loop_.end(), lower_id), loop_.end());
    if (lower_id(loop_.back(), loop_[1])) std::reverse(loop_.begin() + 1, loop_.end());
  }

  const SpanningGraph& graph_;
  Scratch& scratch_;
  std::span<LocalIndex> seen_, parent_, branch_, queue_;
  LocalIndex stamp_ = 0;
  std::vector<LocalIndex> loop_;
};

}  // namespace

void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report) {
  const SpanningGraph cycles = keep_cycles(graph, scratch);
  if (cycles.indices.empty()) return;
  SortedRuns<Origin> origins(scratch.folder() / "origins", scratch.budget() / 8);
  for (LocalIndex v = 0; v < graph.size(); ++v) {
    scratch.trim();
    if (!cycles[v].empty()) origins.add({graph.ids[v], v});
  }
  Search search(cycles, scratch);
  const auto on_loop = scratch.array<std::uint8_t>(graph.size());
  origins.for_each([&](const Origin& origin) {
    if (on_loop[origin.vertex]) return;
    const std::span<const LocalIndex> loop = search.loop_through(origin.vertex);
    for (const LocalIndex v : loop) on_loop[v] = 1;
    if (!loop.empty()) report(loop);
  });
}

}  // namespace lacuna::paper
