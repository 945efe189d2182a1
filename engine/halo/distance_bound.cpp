#include "engine/halo/distance_bound.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace lacuna {
namespace {

struct Near {
  double squared_distance;  // lower bound
  std::uint32_t index;
  bool is_cell;

  friend bool operator<(const Near& a, const Near& b) { return a.squared_distance > b.squared_distance; }
};

struct Far {
  double squared_distance;  // upper bound
  std::uint64_t points;

  friend bool operator<(const Far& a, const Far& b) { return a.squared_distance < b.squared_distance; }
};

// Whether the children of a node would hardly give a nearer bound than the node itself. Otherwise the cell of
// an outlier would go through all cells of a surface far below it, or in the midst of its own box.
bool is_small(const Eigen::AlignedBox3d& node, double farthest) {
  constexpr double kTimes = 8;
  return kTimes * kTimes * max_squared_distance(node, node) <= farthest;
}

}  // namespace

double squared_distance_bound(const Tiling& tiling, std::uint32_t cell, std::size_t k) {
  const Eigen::AlignedBox3d box = tiling.cells[cell].box;
  if (tiling.cells[cell].points > k) return max_squared_distance(box, box);
  if (tiling.nodes[0].points <= k) return std::numeric_limits<double>::infinity();

  // Cells by their nearest corner; done when those whose farthest corner is nearer than any corner to come
  // hold k points and the point itself.
  std::priority_queue<Near> queue;
  queue.push({0, 0, false});
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
  while (!queue.empty()) {
    const Near near = queue.top();
    queue.pop();
    if (points > k && near.squared_distance >= enough.top().squared_distance) break;
    if (near.is_cell) {
      keep({max_squared_distance(box, tiling.cells[near.index].box), tiling.cells[near.index].points});
      continue;
    }
    const CellNode& node = tiling.nodes[near.index];
    const double farthest = max_squared_distance(box, node.box);
    if (is_small(node.box, farthest)) {
      keep({farthest, node.points});
    } else if (node.left != 0) {
      for (const std::uint32_t child : {node.left, node.right}) {
        queue.push({min_squared_distance(box, tiling.nodes[child].box), child, false});
      }
    } else {
      for (std::uint32_t c = node.first; c < node.last; ++c) {
        queue.push({min_squared_distance(box, tiling.cells[c].box), c, true});
      }
    }
  }
  return enough.top().squared_distance;
}

namespace {

struct NearCells {
  const Tiling& tiling;
  const Eigen::AlignedBox3d& box;
  double squared_radius;
  std::uint32_t skip_first, skip_last;
  const std::function<bool(std::uint32_t)>& visit;

  bool within(const Eigen::AlignedBox3d& other) const {
    return min_squared_distance(box, other) <= squared_radius;
  }

  // False when `visit` wants no more.
  bool descend(std::uint32_t index) const {
    const CellNode& node = tiling.nodes[index];
    if (node.first >= skip_first && node.last <= skip_last) return true;
    if (!within(node.box)) return true;
    if (node.left != 0) return descend(node.left) && descend(node.right);
    for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
      const bool skipped = cell >= skip_first && cell < skip_last;
      if (!skipped && within(tiling.cells[cell].box) && !visit(cell)) return false;
    }
    return true;
  }
};

}  // namespace

void for_each_cell_near(const Tiling& tiling, const Eigen::AlignedBox3d& box, double squared_radius,
                        std::uint32_t skip_first, std::uint32_t skip_last,
                        const std::function<bool(std::uint32_t)>& visit) {
  if (!tiling.nodes.empty()) NearCells{tiling, box, squared_radius, skip_first, skip_last, visit}.descend(0);
}

}  // namespace lacuna
