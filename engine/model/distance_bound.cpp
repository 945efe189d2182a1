// SPDX-License-Identifier: Apache-2.0
#include "engine/model/distance_bound.hpp"

#include "engine/model/least_first.hpp"

#include <limits>
#include <queue>

namespace lacuna {
namespace {

struct Far {
  double squared_distance;  // upper bound
  std::uint64_t points;

  friend bool operator<(const Far& a, const Far& b) { return a.squared_distance < b.squared_distance; }
};

// Returns whether the children of a node would hardly give a nearer bound than the node itself. Otherwise the
// cell of an outlier would go through all cells of a surface far below it, or in the midst of its own box.
bool is_small(const Eigen::AlignedBox3d& node, double farthest) {
  constexpr double kTimes = 8;
  return kTimes * kTimes * max_squared_distance(node, node) <= farthest;
}

}  // namespace

double squared_distance_bound(const Tiling& tiling, std::uint32_t cell, std::size_t k) {
  const Eigen::AlignedBox3d box = tiling.cells[cell].box;
  if (tiling.cells[cell].points > k) return max_squared_distance(box, box);
  if (tiling.nodes[0].points <= k) return std::numeric_limits<double>::infinity();

  // Cells come by their nearest corner. The walk collects cells whose farthest corner is nearer than any
  // corner to come. It ends once these hold k points and the point itself.
  std::priority_queue<Far> enough;  // cells that hold more than k points together, the farthest on top
  std::uint64_t points = 0;
  const auto keep = [&](Far far) {
    enough.push(far);
    points += far.points;
    while (points - enough.top().points > k) {
      points -= enough.top().points;
      enough.pop();
    }
  };
  for_each_cell_least_first(
      tiling, [&](const Eigen::AlignedBox3d& other) { return min_squared_distance(box, other); },
      [&](double nearest) { return points > k && nearest >= enough.top().squared_distance; },
      [&](const CellNode& node) {
        const double farthest = max_squared_distance(box, node.box);
        if (!is_small(node.box, farthest)) return true;
        keep({farthest, node.points});
        return false;
      },
      [&](std::uint32_t other) {
        keep({max_squared_distance(box, tiling.cells[other].box), tiling.cells[other].points});
      });
  return enough.top().squared_distance;
}

void for_each_cell_near(const Tiling& tiling, const Eigen::AlignedBox3d& box, double squared_radius,
                        std::uint32_t skip_first, std::uint32_t skip_last,
                        const std::function<bool(std::uint32_t)>& visit) {
  const auto is_near = [&](const Eigen::AlignedBox3d& other) {
    return min_squared_distance(box, other) <= squared_radius;
  };
  std::vector<std::uint32_t> to_come;  // nodes, the next one last
  if (!tiling.nodes.empty()) to_come.push_back(0);
  while (!to_come.empty()) {
    const CellNode& node = tiling.nodes[to_come.back()];
    to_come.pop_back();
    if (node.first >= skip_first && node.last <= skip_last) continue;
    if (!is_near(node.box)) continue;
    if (node.left != 0) {
      to_come.insert(to_come.end(), {node.right, node.left});
      continue;
    }
    for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
      const bool is_skipped = cell >= skip_first && cell < skip_last;
      if (!is_skipped && is_near(tiling.cells[cell].box) && !visit(cell)) return;
    }
  }
}

}  // namespace lacuna
