// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/split.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace lacuna {
namespace {

// Below this number, the order of cells does not matter.
constexpr std::uint32_t kFewCells = 4;

class Splitter {
 public:
  explicit Splitter(TilePlan& plan) : plan_(plan) {}

  void split() { split(0, static_cast<std::uint32_t>(plan_.cells.size()), false); }

 private:
  // `in_tile`: a tile holds these cells already.
  void split(std::uint32_t first, std::uint32_t last, bool in_tile) {
    const Part part = bound(first, last);
    if (!in_tile && part.points <= plan_.tile_points) {
      plan_.tiles.push_back({.first_cell = first, .last_cell = last, .raw = part.points});
      in_tile = true;
    }
    if (in_tile && last - first <= kFewCells) {
      std::sort(plan_.cells.begin() + first, plan_.cells.begin() + last,
                [](const CountedCell& a, const CountedCell& b) { return a.coord < b.coord; });
      return;
    }
    const std::uint32_t middle = halve(part, longest_axis(part));
    split(first, middle, in_tile);
    split(middle, last, in_tile);
  }

  struct Across {
    std::size_t axis;
    bool operator()(const CountedCell& a, const CountedCell& b) const { return (*this)(a.coord, b.coord); }
    bool operator()(const CellCoord& a, const CellCoord& b) const {
      return a[axis] != b[axis] ? a[axis] < b[axis] : a < b;
    }
  };

  struct Part {
    CellCoord low{}, high{};  // tight bounds of its cells
    std::uint32_t first = 0, last = 0;
    std::uint64_t points = 0;
  };

  Part bound(std::uint32_t first, std::uint32_t last) const {
    Part part{.first = first, .last = last};
    if (first == last) return part;
    part.low = part.high = plan_.cells[first].coord;
    for (std::uint32_t i = first; i < last; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        part.low[axis] = std::min(part.low[axis], plan_.cells[i].coord[axis]);
        part.high[axis] = std::max(part.high[axis], plan_.cells[i].coord[axis]);
      }
      part.points += plan_.cells[i].points;
    }
    return part;
  }

  static std::int64_t side(const Part& part, std::size_t axis) {
    return std::int64_t{part.high[axis]} - part.low[axis];
  }
  static std::size_t longest_axis(const Part& part) {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (side(part, axis) > side(part, longest)) longest = axis;
    }
    return longest;
  }

  // Divides the cells across the longest side, half of the points before and half behind. Returns the first
  // cell of the second half.
  std::uint32_t halve(const Part& node, std::size_t longest) {
    // A histogram across finds the slab of cells that holds the half-way point; only that is ordered.
    const auto begin = plan_.cells.begin() + node.first, end = plan_.cells.begin() + node.last;
    const auto most_slabs = std::max<std::uint64_t>(node.last - node.first, 2);
    const auto width = std::bit_width(static_cast<std::uint64_t>(side(node, longest)) / most_slabs);
    const auto slab_of = [&](const CountedCell& cell) {
      return static_cast<std::size_t>((std::int64_t{cell.coord[longest]} - node.low[longest]) >> width);
    };
    slabs_.assign(static_cast<std::size_t>(side(node, longest) >> width) + 1, 0);
    for (auto cell = begin; cell != end; ++cell) slabs_[slab_of(*cell)] += cell->points;
    std::uint64_t before = 0;
    std::size_t half_way = 0;
    while (before + slabs_[half_way] <= node.points / 2) before += slabs_[half_way++];
    const auto slab_begin =
        std::partition(begin, end, [&](const auto& cell) { return slab_of(cell) < half_way; });
    const auto slab_end =
        std::partition(slab_begin, end, [&](const auto& cell) { return slab_of(cell) == half_way; });

    // The half-way point lies in [first, last): halved until that is one cell.
    auto first = slab_begin, last = slab_end;
    while (last - first > 1) {
      const auto middle = first + (last - first) / 2;
      std::nth_element(first, middle, last, Across{longest});
      const std::uint64_t points =
          std::accumulate(first, middle, before,
                          [](std::uint64_t sum, const CountedCell& cell) { return sum + cell.points; });
      if (points <= node.points / 2) {
        before = points;
        first = middle;
      } else {
        last = middle;
      }
    }
    const auto half = static_cast<std::uint32_t>(first - plan_.cells.begin());
    return std::clamp(half, node.first + 1, node.last - 1);
  }

  TilePlan& plan_;
  std::vector<std::uint64_t> slabs_;  // points of each
};

}  // namespace

std::uint64_t TilePlan::group_points(std::size_t group) const {
  const std::uint64_t counted = group < heavy.size() ? heavy[group].points : far_points;
  return counted < kMostCounted ? counted : points;  // counting ended there
}

std::uint64_t TilePlan::most_tiles() const {
  std::uint64_t most = tiles.size();
  for (std::size_t group = 0; group < groups(); ++group)
    most += (group_points(group) + tile_points - 1) / tile_points;
  return most;
}

TilePlan split_tiles(SurveyedScan& survey, std::uint64_t tile_points) {
  TilePlan plan{{.grid = survey.grid,
                 .far_points = survey.far_points,
                 .points = survey.points - survey.dropped,
                 .tile_points = tile_points},
                std::move(survey.cells),
                {},
                {}};
  const auto heavy = std::partition(plan.cells.begin(), plan.cells.end(),
                                    [&](const CountedCell& cell) { return cell.points <= tile_points; });
  plan.heavy.assign(heavy, plan.cells.end());
  plan.cells.erase(heavy, plan.cells.end());
  if (!plan.cells.empty()) Splitter(plan).split();
  std::uint64_t row = 0;
  for (Tile& tile : plan.tiles) {
    tile.first_row = Row{row};
    row = aligned_row(row + tile.raw);
  }
  return plan;
}

}  // namespace lacuna
