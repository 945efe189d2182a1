// SPDX-License-Identifier: Apache-2.0
// The best-first walk over the cells of a scan.
#pragma once

#include "engine/model/tiling.hpp"

#include <cstdint>
#include <queue>

namespace lacuna {

// Calls visit(cell) for cells in ascending order of least(box), a number that is no larger for a larger box.
// It passes over the cells of a node where enter(node) is false. It ends where is_enough(least) is true of
// the least number to come. Cost: the nodes on the way to the visited cells, times the logarithm of their
// number.
template <class Least, class IsEnough, class Enter, class Visit>
void for_each_cell_least_first(const Tiling& tiling, Least&& least, IsEnough&& is_enough, Enter&& enter,
                               Visit&& visit) {
  struct NodeOrCell {
    double least;
    std::uint32_t index;
    bool is_cell;

    bool operator<(const NodeOrCell& other) const { return least > other.least; }  // the least one on top
  };
  std::priority_queue<NodeOrCell> queue;
  if (!tiling.nodes.empty()) queue.push({least(tiling.nodes[0].box), 0, false});
  while (!queue.empty() && !is_enough(queue.top().least)) {
    const NodeOrCell next = queue.top();
    queue.pop();
    if (next.is_cell) {
      visit(next.index);
      continue;
    }
    const CellNode& node = tiling.nodes[next.index];
    if (!enter(node)) continue;
    if (node.left != 0) {
      for (const std::uint32_t child : {node.left, node.right})
        queue.push({least(tiling.nodes[child].box), child, false});
    } else {
      for (std::uint32_t cell = node.first; cell < node.last; ++cell)
        queue.push({least(tiling.cells[cell].box), cell, true});
    }
  }
}

}  // namespace lacuna
