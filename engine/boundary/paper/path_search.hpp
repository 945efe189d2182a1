// SPDX-License-Identifier: Apache-2.0
// Finds whether a path of few edges joins two vertices.
#pragma once

#include "engine/model/ids.hpp"

#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace lacuna::paper {

// Two balls grow towards each other, the smaller front first. It keeps its memory for the next search.
class PathSearch {
 public:
  // Returns whether there is a path of at most `limit` edges. `mark_of(v)` is a number of vertex v, by
  // reference. It is 0 before the first search. `for_each_neighbour(v, visit)` calls `visit(w)`. Cost: the
  // vertices within limit / 2 steps.
  template <class MarkOf, class ForEachNeighbour>
  bool connects(LocalIndex a, LocalIndex b, std::int64_t limit, MarkOf&& mark_of,
                ForEachNeighbour&& for_each_neighbour) {
    assert(stamp_ <= std::numeric_limits<std::uint32_t>::max() - 4);
    stamp_ += 2;
    std::uint32_t here = stamp_, there = stamp_ + 1;
    near_.assign(1, a);
    far_.assign(1, b);
    mark_of(a) = here;
    mark_of(b) = there;
    for (std::int64_t length = 0; length < limit && !near_.empty() && !far_.empty(); ++length) {
      if (near_.size() > far_.size()) {
        near_.swap(far_);
        std::swap(here, there);
      }
      // One step of the near front, until it touches the far ball.
      bool touches = false;
      next_.clear();
      for (const LocalIndex v : near_) {
        for_each_neighbour(v, [&](LocalIndex w) {
          std::uint32_t& mark = mark_of(w);
          if (mark == there) touches = true;
          if (mark >= stamp_) return;
          mark = here;
          next_.push_back(w);
        });
        if (touches) return true;
      }
      near_.swap(next_);
    }
    return false;
  }

 private:
  std::uint32_t stamp_ = 0;
  std::vector<LocalIndex> near_, far_, next_;  // fronts
};

}  // namespace lacuna::paper
