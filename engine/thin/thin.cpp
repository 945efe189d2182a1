// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/thin.hpp"

#include "engine/bucket/split.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// Counts how many points are left in each node.
std::vector<std::uint64_t> count_nodes(const Tiling& below, const ChosenPoints& chosen) {
  std::vector<std::uint64_t> counts(below.nodes.size());
  for (std::size_t n = below.nodes.size(); n-- > 0;) {  // children stand behind their parents
    const CellNode& node = below.nodes[n];
    counts[n] = node.left != 0 ? counts[node.left] + counts[node.right]
                               : std::accumulate(chosen.in_cell.begin() + node.first,
                                                 chosen.in_cell.begin() + node.last, std::uint64_t{0});
  }
  return counts;
}

std::uint64_t count_tiles(const Tiling& below, const ChosenPoints& chosen, TileIndex first, TileIndex last) {
  const auto begin = chosen.in_cell.begin();
  return first == last ? 0
                       : std::accumulate(begin + below.tiles[first].first_cell,
                                         begin + below.tiles[last - 1].last_cell, std::uint64_t{0});
}

// Behind the last tile below.
TileIndex end_of(const TileJoin& join, std::size_t t, const TileRange& below) {
  return t + 1 < join.first.size() ? join.first[t + 1] : below.last;
}

// The cells of the store below that become one cell. All belong to one tile below.
struct JoinedCells {
  std::uint32_t first, last;
  std::uint64_t points;
};

// Goes down the tree over the cells below until nodes are as small as tiles and cells are to be.
class Joiner {
 public:
  Joiner(const Tiling& below, const ChosenPoints& chosen, std::uint64_t tile_points,
         std::uint64_t cell_points)
      : below_(below),
        range_(chosen.tiles),
        in_cell_(chosen.in_cell),
        counts_(count_nodes(below, chosen)),
        tile_points_(tile_points),
        cell_points_(cell_points) {}

  std::vector<TileIndex> first_tiles() {
    if (!below_.nodes.empty()) add_tiles(0);
    return std::move(tiles_);
  }
  std::vector<JoinedCells> cells() {
    if (!below_.nodes.empty()) add_cells(0);
    return std::move(cells_);
  }

 private:
  void add_tiles(std::uint32_t n) {
    const CellNode& node = below_.nodes[n];
    const TileIndex first = below_.tile_of_cell(node.first), last = below_.tile_of_cell(node.last - 1);
    if (last < range_.first || first >= range_.last) return;
    const bool is_within = first >= range_.first && last < range_.last;
    if (first == last || (is_within && counts_[n] <= tile_points_)) {
      tiles_.push_back(first);
    } else if (node.left != 0) {
      add_tiles(node.left);
      add_tiles(node.right);
    } else {
      for (TileIndex t = std::max(first, range_.first); t <= std::min(last, range_.last - 1); ++t)
        tiles_.push_back(t);
    }
  }

  void add_cells(std::uint32_t n) {
    const CellNode& node = below_.nodes[n];
    if (node.left != 0 && counts_[n] > cell_points_) {
      add_cells(node.left);
      add_cells(node.right);
      return;
    }
    const std::size_t before = cells_.size();
    for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
      if (in_cell_[cell] == 0) continue;
      const bool fits = cells_.size() > before && cells_.back().points + in_cell_[cell] <= cell_points_ &&
                        below_.tile_of_cell(cells_.back().first) == below_.tile_of_cell(cell);
      if (!fits) cells_.push_back({cell, cell, 0});
      cells_.back().last = cell + 1;
      cells_.back().points += in_cell_[cell];
    }
  }

  const Tiling& below_;
  const TileRange range_;
  const std::vector<std::uint32_t>& in_cell_;
  std::vector<std::uint64_t> counts_;  // of nodes
  std::uint64_t tile_points_, cell_points_;
  std::vector<TileIndex> tiles_;
  std::vector<JoinedCells> cells_;
};

// The points of one tile, as they are put into the store.
struct JoinedTile {
  std::vector<ScanPoint> points;
  std::vector<PlainNormal> normals;
  std::vector<Cell> cells;
};

void add_chosen(const TileStore& below, TileIndex t, const RowSet& rows, JoinedTile& to) {
  const Tile& tile = below.tiling().tiles[t];
  const std::vector<Eigen::Vector3d> normals = below.normals(t);
  LocalIndex owned = 0;
  below.for_each_point(t, [&](const ScanPoint& p) {
    if (rows.contains(tile.row(owned))) {
      to.points.push_back(p);
      if (below.has_normals()) {
        const Eigen::Vector3d& n = normals[owned];
        to.normals.push_back({n.x(), n.y(), n.z()});
      }
    }
    ++owned;
  });
}

void add_cells(std::span<const JoinedCells> joined, JoinedTile& to) {
  std::size_t next = 0;
  for (const JoinedCells& cells : joined) {
    Cell cell{.points = cells.points};
    for (std::uint64_t i = 0; i < cell.points; ++i) cell.box.extend(to.points[next++].position());
    to.cells.push_back(cell);
  }
}

// Makes a level of the chosen points.
Level level_of(ChosenPoints chosen, const Level& below, std::size_t number, double edge, std::size_t tasks,
               StoreFiles files, Job& job) {
  const std::uint64_t about = chosen.count * tasks;  // of the level
  const TileJoin join =
      join_tiles(below.store.tiling(), chosen, points_per_tile(about, job.config, job.workers),
                 points_per_cell(about, job.workers.memory));
  return {.number = number,
          .edge = edge,
          .survey = below.survey,
          .extent = below.extent,
          .tile_points = join.tile_points,
          .store = store_chosen(below.store, chosen, join, std::move(files), job.workers),
          .input = below.input,
          .represented = std::move(chosen.represented)};
}

// Cells as large as the scan leave too few points to have neighbours. A scan of few points, or of one place,
// has no more points at any resolution.
void refuse_too_coarse(std::uint64_t left, const SurveyTotals& survey, const Config& config) {
  const std::uint64_t finite = survey.points - survey.dropped;
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  const Eigen::Vector3d size = Eigen::AlignedBox3d(survey.bounds).sizes();
  if (left > k || finite <= k || size.isZero(0)) return;
  const ScaleConfig& scale = config.scale;
  const bool is_of_hole = scale.resolution == 0;
  std::ostringstream message;
  message << "a resolution of " << first_edge(scale);
  if (is_of_hole) message << ", for holes of " << scale.min_hole << ",";
  message << " leaves " << left << " of " << finite << " points, too few for k = " << k
          << " neighbours; the scan's size is " << size.x() << " x " << size.y() << " x " << size.z()
          << "; allowed: a smaller " << (is_of_hole ? "--min-hole" : "--resolution");
  throw Error(message.str());
}

// Returns the first power of sqrt 2 above a length.
double power_above(double length) {
  const double octave = std::ldexp(1.0, std::ilogb(length));
  return octave * std::numbers::sqrt2 > length ? octave * std::numbers::sqrt2 : 2 * octave;
}

// Returns the share of the points that cells of this edge leave. Where a cell of a surface has n points on
// average, the share is about 1 / (1 + n / 2).
double share_left(const LengthBins& distances, double edge) {
  constexpr double kCellsOfSurface = 1.3;  // to cover one cell's area, as surfaces are tilted
  double left = 0, all = 0;
  for (const auto& [bin, count] : distances.counts) {
    const double cells_per_spacing = edge * kDistanceOverSpacing / LengthBins::start_of(bin);
    left += static_cast<double>(count) / (1 + cells_per_spacing * cells_per_spacing / kCellsOfSurface / 2);
    all += static_cast<double>(count);
  }
  return left / all;
}

}  // namespace

TileJoin join_tiles(const Tiling& below, const ChosenPoints& chosen, std::uint64_t tile_points,
                    std::uint64_t cell_points) {
  return {Joiner(below, chosen, tile_points, cell_points).first_tiles(), tile_points, cell_points};
}

TileStore store_chosen(const TileStore& below, const ChosenPoints& chosen, const TileJoin& join,
                       StoreFiles files, const Workers& workers) {
  constexpr std::uint64_t kBytesPerPoint = 128;  // while it is put
  const Tiling& tiling = below.tiling();
  StoreWriter store(std::move(files), join.first.size(), below.precision(), below.has_normals());
  std::vector<std::uint64_t> needs;
  for (std::size_t t = 0; t < join.first.size(); ++t) {
    const std::uint64_t points = count_tiles(tiling, chosen, join.first[t], end_of(join, t, chosen.tiles));
    store.reserve(points);
    needs.push_back(points * kBytesPerPoint);
  }
  const std::vector<JoinedCells> cells = Joiner(tiling, chosen, join.tile_points, join.cell_points).cells();
  workers.for_each_within(workers.memory.tiles, needs, [&](std::size_t t) {
    JoinedTile to;
    to.points.reserve(needs[t] / kBytesPerPoint);
    const TileIndex first = join.first[t], last = end_of(join, t, chosen.tiles);
    for (TileIndex b = first; b < last; ++b) add_chosen(below, b, chosen.rows, to);
    const auto lies_before = [](const JoinedCells& joined, std::uint32_t cell) {
      return joined.first < cell;
    };
    const auto begin =
        std::lower_bound(cells.begin(), cells.end(), tiling.tiles[first].first_cell, lies_before);
    const auto end = std::lower_bound(begin, cells.end(), tiling.tiles[last - 1].last_cell, lies_before);
    add_cells({begin, end}, to);
    store.put(static_cast<TileIndex>(t), to.points, to.normals, std::move(to.cells));
  });
  return store.finish();
}

Level thin_to_first(const Level& all, StoreFiles files, Job& job) {
  Phase phase(job.phases, "thin", all.store.tiling().points());
  const double edge = first_edge(job.config.scale);
  const std::uint64_t represented_ids = job.config.results.points ? all.survey.ids : 0;
  ChosenPoints chosen = choose_points(all.store, all.store.tiling().tiles_in({}), edge, represented_ids,
                                      job.spill, job.workers);
  refuse_too_coarse(chosen.count, all.survey, job.config);
  return level_of(std::move(chosen), all, 0, edge, 1, std::move(files), job);
}

double edge_above(const Level& below, const LengthBins& distances) {
  constexpr double kWantedLeft = 0.6;
  if (distances.counts.empty()) return 0;
  const double least = LengthBins::start_of(distances.counts.begin()->first) / 4;
  double edge = power_above(std::max(below.edge * 1.0001, least));  // edges are rounded powers
  while (share_left(distances, edge) > kWantedLeft) edge = power_above(edge * 1.0001);
  return edge;
}

Level thin_above(const Level& below, const TaskShare& share, double edge, StoreFiles files, Job& job) {
  ChosenPoints chosen =
      choose_points(below.store, below.store.tiling().tiles_in(share), edge, 0, job.spill, job.workers);
  return level_of(std::move(chosen), below, below.number + 1, edge, share.tasks, std::move(files), job);
}

bool has_levels(const Config& config) {
  const ScaleConfig& scale = config.scale;
  return config.loops.method == LoopMethod::kTangential && !scale.every_point && scale.resolution == 0;
}

}  // namespace lacuna
