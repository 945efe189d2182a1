// SPDX-License-Identifier: Apache-2.0
#include "engine/halo/halo.hpp"

#include "engine/bucket/split.hpp"
#include "engine/model/distance_bound.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/neighbours/block_search.hpp"
#include "engine/neighbours/store_search.hpp"
#include "engine/run/error.hpp"
#include "engine/store/append_lists.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>

namespace lacuna {
namespace {

// Cells near a cell hold some hundreds of points, or, near a scanner, a multiple of its own points. A cell
// whose distance bound holds more than both holds an outlier.
constexpr std::uint64_t kFarPoints = 32'768, kFarShare = 64;

// Cells that are searched together may hold about this many points, even in a tile of fewer points.
constexpr std::uint64_t kGroupPoints = kFarPoints / 4;

// Border cells to be searched together, and all cells within their distance bounds.
struct Group {
  std::vector<std::uint32_t> border;
  std::vector<std::uint32_t> cells;

  bool empty() const { return border.empty(); }
};

// The plan of a tile.
struct Border {
  std::vector<Group> groups;
  std::vector<std::uint32_t> far_cells;
};

std::uint64_t points_of(const Tiling& tiling, std::span<const std::uint32_t> cells) {
  std::uint64_t points = 0;
  for (const std::uint32_t cell : cells) points += tiling.cells[cell].points;
  return points;
}

void sort_unique(std::vector<std::uint32_t>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

// The tiles whose inboxes are wanted.
class WantedTiles {
 public:
  WantedTiles(const Tiling& tiling, std::span<const TileIndex> tiles)
      : tiling_(tiling), boxes_(tiling.tiles.size()), is_wanted_(tiling.tiles.size()) {
    for (const TileIndex t : tiles) is_wanted_[t] = 1;
    for (TileIndex t = 0; t < boxes_.size(); ++t) {
      const Tile& tile = tiling.tiles[t];
      for (std::uint32_t c = tile.first_cell; c < tile.last_cell; ++c) boxes_[t].extend(tiling.cells[c].box);
    }
  }

  bool contains(TileIndex t) const { return is_wanted_[t] != 0; }
  bool contains_cell(std::uint32_t cell) const { return contains(tiling_.tile_of_cell(cell)); }
  const Eigen::AlignedBox3d& box(TileIndex t) const { return boxes_[t]; }

  // Returns the wanted tiles that lie near a box.
  std::vector<TileIndex> near(const Eigen::AlignedBox3d& box, double squared_radius) const {
    std::vector<TileIndex> found;
    for (TileIndex t = 0; t < boxes_.size(); ++t) {
      if (contains(t) && min_squared_distance(box, boxes_[t]) <= squared_radius) found.push_back(t);
    }
    return found;
  }

 private:
  const Tiling& tiling_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // by tile
  std::vector<std::uint8_t> is_wanted_;     // by tile
};

// Finds the cells of a tile whose points may have neighbours in other tiles, or be neighbours of their
// points. For a tile that is not wanted itself, only possible neighbours of a wanted tile count.
class BorderPlan {
 public:
  // The cells of a group hold about `group_points` points at most.
  BorderPlan(const Tiling& tiling, TileIndex tile, const WantedTiles& wanted, std::size_t k,
             std::uint64_t group_points)
      : tiling_(tiling),
        tile_(tiling.tiles[tile]),
        wanted_(wanted),
        all_count_(wanted.contains(tile)),
        k_(k),
        group_points_(group_points) {
    const Eigen::AlignedBox3d& box = wanted.box(tile);
    if (!all_count_ && tile_.points > k) wanted_near_ = wanted.near(box, max_squared_distance(box, box));
    if (all_count_ || tile_.points <= k || !wanted_near_.empty()) visit(0);
    close_group();
  }

  const Border& border() const { return border_; }

 private:
  void visit(std::uint32_t index) {
    const CellNode& node = tiling_.nodes[index];
    if (node.last <= tile_.first_cell || node.first >= tile_.last_cell) return;
    const bool inside = node.first >= tile_.first_cell && node.last <= tile_.last_cell;
    if (inside && is_interior(node)) return;
    if (node.left != 0) {
      visit(node.left);
      visit(node.right);
      return;
    }
    plan_leaf(node);
  }

  // More than k points within a box have their neighbours within its diagonal.
  bool is_interior(const CellNode& node) const {
    if (node.points <= k_) return false;
    const Eigen::AlignedBox3d box = node.box;
    return !leaves_tile(box, max_squared_distance(box, box));
  }

  bool leaves_tile(const Eigen::AlignedBox3d& box, double squared_distance_bound) const {
    if (!may_count(box, squared_distance_bound)) return false;
    bool leaves = false;
    for_each_cell_near(tiling_, box, squared_distance_bound, tile_.first_cell, tile_.last_cell,
                       [&](std::uint32_t cell) {
                         leaves = all_count_ || wanted_.contains_cell(cell);
                         return !leaves;
                       });
    return leaves;
  }

  // Returns whether the box may be near a wanted tile. A tile of k points or fewer has no bound of its own.
  bool may_count(const Eigen::AlignedBox3d& box, double squared_radius) const {
    return all_count_ || tile_.points <= k_ ||
           std::any_of(wanted_near_.begin(), wanted_near_.end(), [&](TileIndex t) {
             return min_squared_distance(box, wanted_.box(t)) <= squared_radius;
           });
  }

  // Returns at least the squared distance from any point of the cell to its k-th neighbour.
  double bound_of(std::uint32_t cell, const CellNode& node) const {
    const Eigen::AlignedBox3d box = tiling_.cells[cell].box;
    if (tiling_.cells[cell].points <= k_ && node.points > k_) return max_squared_distance(box, node.box);
    return squared_distance_bound(tiling_, cell, k_);
  }

  struct BorderCell {
    std::uint32_t cell;
    double squared_distance_bound;
  };

  void plan_leaf(const CellNode& node) {
    std::vector<BorderCell> border;
    const std::uint32_t last = std::min(node.last, tile_.last_cell);
    for (std::uint32_t cell = std::max(node.first, tile_.first_cell); cell < last; ++cell) {
      const double bound = bound_of(cell, node);
      if (leaves_tile(tiling_.cells[cell].box, bound)) border.push_back({cell, bound});
    }
    plan(border);
  }

  // Cells next to each other share most of the cells around them.
  void plan(std::span<const BorderCell> border) {
    if (border.empty()) return;
    Eigen::AlignedBox3d box;
    double bound = 0;
    std::uint64_t own = 0;
    for (const BorderCell& b : border) {
      box.extend(tiling_.cells[b.cell].box);
      bound = std::max(bound, b.squared_distance_bound);
      own += tiling_.cells[b.cell].points;
    }
    const std::uint64_t most = std::max(kFarPoints, kFarShare * own);
    near_cells_.clear();
    std::uint64_t points = 0;
    for_each_cell_near(tiling_, box, bound, 0, 0, [&](std::uint32_t near) {
      near_cells_.push_back(near);
      points += tiling_.cells[near].points;
      return points <= most;
    });
    if (points > most) {
      if (border.size() == 1) {
        border_.far_cells.push_back(border.front().cell);
      } else {
        for (const BorderCell& b : border) plan(std::span(&b, 1));
      }
      return;
    }
    for (const BorderCell& b : border) group_.border.push_back(b.cell);
    group_.cells.insert(group_.cells.end(), near_cells_.begin(), near_cells_.end());
    gathered_ += points;
    if (gathered_ > 8 * group_points_) {  // neighbours share most cells: count each once
      sort_unique(group_.cells);
      gathered_ = points_of(tiling_, group_.cells);
      if (gathered_ > group_points_) close_group();
    }
  }

  void close_group() {
    if (group_.empty()) return;
    sort_unique(group_.cells);
    border_.groups.push_back(std::move(group_));
    group_ = {};
    gathered_ = 0;
  }

  const Tiling& tiling_;
  const Tile& tile_;
  const WantedTiles& wanted_;
  bool all_count_;
  std::size_t k_;
  std::uint64_t group_points_;
  std::vector<TileIndex> wanted_near_;
  Border border_;
  Group group_;
  std::uint64_t gathered_ = 0;
  std::vector<std::uint32_t> near_cells_;
};

class HaloBuilder {
 public:
  HaloBuilder(const TileStore& store, std::size_t k, TileIndex tile, const WantedTiles& wanted,
              AppendLists<HaloEdge>& inboxes)
      : store_(store),
        tiling_(store.tiling()),
        k_(k),
        tile_(tile),
        wanted_(wanted),
        outbox_(inboxes),
        far_search_(store) {}

  void send_edges_of_group(const Group& group) {
    std::vector<ScanPoint> stored;
    std::vector<Row> rows;
    store_.read_cells(group.cells, stored, rows);
    std::vector<Eigen::Vector3d> positions;
    std::vector<PointId> ids;
    for (const ScanPoint& p : stored) {
      positions.push_back(p.position());
      ids.push_back(p.id);
    }
    BlockSearch search(positions, ids);
    for (const std::uint32_t cell : group.border) {
      const Row first = tiling_.cells[cell].first_row;
      const auto begin =
          static_cast<LocalIndex>(std::lower_bound(rows.begin(), rows.end(), first) - rows.begin());
      const auto end = static_cast<LocalIndex>(begin + tiling_.cells[cell].points);
      search.nearest(begin, end, k_, [&](LocalIndex p, std::span<const LocalIndex> found) {
        for (const LocalIndex q : found) send_edge(stored[p], rows[p], stored[q], rows[q]);
      });
    }
  }

  void send_edges_of_far_cell(std::uint32_t cell) {
    const std::vector<ScanPoint> points = store_.cell(cell);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Row row{value(tiling_.cells[cell].first_row) + i};
      for (const StoreNeighbour& near : far_search_.nearest(points[i], row, k_))
        send_edge(points[i], row, near, near.row);
    }
  }

  void send() { outbox_.send(); }

 private:
  // p has q among its k nearest.
  void send_edge(const ScanPoint& p, Row p_row, const ScanPoint& q, Row q_row) {
    const Tile& here = tiling_.tiles[tile_];
    if (here.owns(q_row)) return;
    const TileIndex there = tiling_.tile_of_row(q_row);
    if (wanted_.contains(tile_)) outbox_.add(tile_, {q_row, q, here.local(p_row), 0});
    if (wanted_.contains(there)) outbox_.add(there, {p_row, p, tiling_.tiles[there].local(q_row), 1});
  }

  const TileStore& store_;
  const Tiling& tiling_;
  std::size_t k_;
  TileIndex tile_;
  const WantedTiles& wanted_;
  Outbox<HaloEdge> outbox_;
  StoreSearch far_search_;
};

}  // namespace

double extent_of(const Eigen::AlignedBox3d& bounds) {
  return bounds.isEmpty() ? 0 : std::sqrt(squared_distance(bounds.max(), bounds.min()));
}

double eps_length(const NeighbourhoodConfig& config, double extent) {
  return config.eps > 0 ? config.eps : config.eps_fraction * extent;
}

std::uint64_t ball_bytes(const Tiling& tiling, const Tile& tile, double eps, std::uint64_t most) {
  // A neighbour is in the list of its ball and in the neighbourhood.
  constexpr std::uint64_t kBytes = 2 * sizeof(LocalIndex);
  std::uint64_t bytes = 0;
  if (eps == 0) return bytes;
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell && bytes <= most; ++cell) {
    const std::uint64_t queries = tiling.cells[cell].points;
    for_each_cell_near(tiling, tiling.cells[cell].box, eps * eps, 0, 0, [&](std::uint32_t near) {
      bytes += kBytes * queries * tiling.cells[near].points;
      return bytes <= most;
    });
  }
  return bytes;
}

// Such a tile is alone at work, and the bound is about twice the memory that it takes.
std::uint64_t most_ball_bytes(const Memory& memory) {
  return 2 * memory.tiles;
}

void refuse_balls(const Tiling& tiling, double eps, const Workers& workers) {
  if (eps == 0) return;
  const std::uint64_t most = most_ball_bytes(workers.memory);
  std::atomic<bool> fits = true;
  workers.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    if (fits && ball_bytes(tiling, tiling.tiles[t], eps, most) > most) fits = false;
  });
  if (fits) return;
  std::ostringstream message;
  message << "eps of " << eps << ": the points within it of one tile's points may take more than "
          << print_bytes(most) << ", which is what memory_limit " << print_bytes(workers.memory.limit)
          << " leaves for them; allowed: a smaller eps, smaller tile_points or a larger memory_limit";
  throw Error(message.str());
}

AppendLists<HaloEdge> exchange_halo(const TileStore& store, std::span<const TileIndex> tiles, Job& job) {
  const Tiling& tiling = store.tiling();
  const auto k = static_cast<std::size_t>(job.config.neighbourhood.k);
  Phase phase(job.phases, "halo", tiling.points());
  std::vector<std::uint64_t> needs;
  for (const Tile& tile : tiling.tiles)
    needs.push_back(tile_bytes(std::max(tile.points, kGroupPoints), job.config));
  AppendLists<HaloEdge> inboxes(job.spill, "halo", tiling.tiles.size());
  if (tiles.empty()) return inboxes;
  const WantedTiles wanted(tiling, tiles);
  job.workers.for_each_within(job.workers.memory.tiles, needs, [&](std::size_t t) {
    const Tile& tile = tiling.tiles[t];
    const std::uint64_t group_points = std::max(tile.points, kGroupPoints);
    const BorderPlan plan(tiling, static_cast<TileIndex>(t), wanted, k, group_points);
    HaloBuilder builder(store, k, static_cast<TileIndex>(t), wanted, inboxes);
    for (const Group& group : plan.border().groups) builder.send_edges_of_group(group);
    for (const std::uint32_t cell : plan.border().far_cells) builder.send_edges_of_far_cell(cell);
    builder.send();
    phase.advance(tile.points);
  });
  return inboxes;
}

}  // namespace lacuna
