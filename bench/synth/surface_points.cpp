// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface_points.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

namespace lacuna::synth {

namespace {

// ---- The holes

constexpr double kMaxElongation = 1.6;  // long over short axis of a hole
constexpr double kMargin = 6;           // nodes between a hole and the edge of its cell

// Fewer, larger cells while they still hold all the holes: spreads the holes over the whole surface.
void widen_cells(std::uint64_t holes, double height, double width, std::uint32_t& down,
                 std::uint32_t& across) {
  while (true) {
    const bool rows_next = height / down < width / across;
    if (rows_next && std::uint64_t{down - 1} * across >= holes)
      --down;
    else if (std::uint64_t{down} * (across - 1) >= holes)
      --across;
    else if (std::uint64_t{down - 1} * across >= holes)
      --down;
    else
      return;
  }
}

// Holes are ellipses in the plane of the grid, at most one per cell of a coarse lattice and wholly inside it.
// So no hole comes near another one, the outer edge, a density step or the edge of a panel.
//
// On a jittered grid, the surface is the quads whose four nodes exist. A loop is the closed chain of edges
// with exactly one such quad. A hole has exactly one loop, which visits no node twice, because the nodes that
// it takes are those inside a convex curve. A line through a node next to it has one of the node's quads on
// its far side. So no node is left without a quad. If a node's only quads were two opposite ones, it would
// lie between two removed nodes, so inside.
class HoleField {
 public:
  // Throws `Error` when the holes do not fit.
  HoleField(const SurfaceGrid& grid, const SurfaceOptions& options) : grid_(grid) {
    if (options.holes == 0) return;
    const double reach = std::ceil(options.hole_radius[1] * std::sqrt(kMaxElongation)) + kMargin;
    // The holes keep to the full half; on a tube its first column is a step, too.
    const std::uint32_t width = grid.stride > 1 ? grid.step_column + 1 : grid.panel_columns();
    down_ = static_cast<std::uint32_t>(grid.rows / (2 * reach + 1));
    across_ = static_cast<std::uint32_t>(width / (2 * reach + 1));
    const std::uint64_t room = std::uint64_t{down_} * across_ * grid.panels;
    if (options.holes > room)
      throw UsageError(
          "--holes " + std::to_string(options.holes) + ": only " + std::to_string(room) +
          " holes of this radius fit on this surface; plant fewer or smaller ones, or more points");
    widen_cells((options.holes + grid.panels - 1) / grid.panels, grid.rows, width, down_, across_);
    cell_rows_ = grid.rows / down_;
    cell_columns_ = width / across_;

    const std::uint64_t cells_of_panel = std::uint64_t{down_} * across_;
    const Permutation cells(cells_of_panel * grid.panels, mix(options.seed));
    const Random random(options.seed, 0x401e5);
    hole_of_cell_.assign(cells_of_panel * grid.panels, -1);
    holes_.reserve(options.holes);
    for (std::uint64_t hole = 0; hole < options.holes; ++hole) {
      const std::uint64_t cell = cells(hole);
      hole_of_cell_[cell] = static_cast<std::int32_t>(hole);
      const double top = static_cast<double>(cell % cells_of_panel / across_ * cell_rows_);
      const double left = static_cast<double>(cell / cells_of_panel * grid.panel_columns() +
                                              cell % cells_of_panel % across_ * cell_columns_);
      const double radius = random.uniform(5 * hole, options.hole_radius[0], options.hole_radius[1]);
      const double elongation = random.uniform(5 * hole + 1, 1, kMaxElongation);
      const auto [sin, cos] = sin_cos(0.5 * random.uniform(5 * hole + 2));
      const double along = 1 / (radius * radius * elongation);
      const double across = elongation / (radius * radius);
      holes_.push_back({.row = top + random.uniform(5 * hole + 3, reach, cell_rows_ - reach),
                        .column = left + random.uniform(5 * hole + 4, reach, cell_columns_ - reach),
                        .a = along * cos * cos + across * sin * sin,
                        .b = (along - across) * sin * cos,
                        .c = along * sin * sin + across * cos * cos});
    }
  }

  std::size_t size() const { return holes_.size(); }

  // A hole is far from the edges of its cell. So a place between two cells may count to either of them.
  bool takes(double row, double column) const {
    const std::uint32_t down = static_cast<std::uint32_t>(std::max(row, 0.0)) / cell_rows_;
    const auto from_left = static_cast<std::uint32_t>(std::max(column, 0.0));
    const std::uint32_t across = from_left % grid_.panel_columns() / cell_columns_;
    const std::size_t panel = from_left / grid_.panel_columns();
    if (down >= down_ || across >= across_ || panel >= grid_.panels) return false;
    const std::int32_t index = hole_of_cell_[(panel * down_ + down) * across_ + across];
    return index >= 0 && holes_[static_cast<std::size_t>(index)].form(row, column) <= 1;
  }

  // Returns the hole's edge.
  Outline outline(std::size_t hole) const {
    const Ellipse& ellipse = holes_[hole];
    // The sum of the squared half axes is the trace of the inverse form.
    const double squares = (ellipse.a + ellipse.c) / (ellipse.a * ellipse.c - ellipse.b * ellipse.b);
    return {kTwoPi * std::sqrt(0.5 * squares), [ellipse](double t) {
              const auto [sin, cos] = sin_cos(t);
              const double scale = 1 / std::sqrt(ellipse.form(ellipse.row + sin, ellipse.column + cos));
              return GridPosition{ellipse.row + scale * sin, ellipse.column + scale * cos};
            }};
  }

  // Returns one loop per hole, each closed, in the order of its edges.
  std::vector<NumberLoop> loops() const {
    std::vector<NumberLoop> all;
    for (const Ellipse& hole : holes_) all.push_back(trace(hole));
    return all;
  }

 private:
  // The ellipse is a dx^2 + 2 b dx dy + c dy^2 <= 1, with dx along the columns.
  struct Ellipse {
    double row, column;
    double a, b, c;

    double form(double at_row, double at_column) const {
      const double dx = at_column - column;
      const double dy = at_row - row;
      return a * dx * dx + 2 * b * dx * dy + c * dy * dy;
    }
    bool takes(std::int64_t at_row, std::int64_t at_column) const {
      return form(static_cast<double>(at_row), static_cast<double>(at_column)) <= 1;
    }
    bool quad_is_whole(std::int64_t top, std::int64_t left) const {
      return !takes(top, left) && !takes(top, left + 1) && !takes(top + 1, left) && !takes(top + 1, left + 1);
    }
  };

  // Walks from a node of the loop along its boundary edges, never back, until it reaches the node again.
  NumberLoop trace(const Ellipse& hole) const {
    struct Step {
      int row, column;
    };
    constexpr std::array<Step, 4> kSteps{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};
    const auto column0 = static_cast<std::int64_t>(std::floor(hole.column + 0.5));
    auto row0 = static_cast<std::int64_t>(std::floor(hole.row + 0.5));
    while (hole.takes(row0, column0)) --row0;

    NumberLoop loop;
    std::int64_t row = row0, column = column0;
    std::size_t came = kSteps.size();
    do {
      loop.push_back(grid_.node(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)));
      for (std::size_t way = 0; way < kSteps.size(); ++way) {
        const auto [down, right] = kSteps[way];
        if (came < kSteps.size() && way == (came ^ 2)) continue;
        // The quads on both sides of the edge from this node to the next.
        const std::int64_t top = std::min(row, row + down);
        const std::int64_t left = std::min(column, column + right);
        const bool one = hole.quad_is_whole(top, left);
        const bool other = hole.quad_is_whole(right != 0 ? top - 1 : top, down != 0 ? left - 1 : left);
        if (one == other) continue;
        row += down;
        column += right;
        came = way;
        break;
      }
    } while (row != row0 || column != column0);
    return loop;
  }

  SurfaceGrid grid_;
  std::uint32_t cell_rows_ = 1, cell_columns_ = 1;  // nodes per cell
  std::uint32_t down_ = 0, across_ = 0;             // cells, of one panel
  std::vector<Ellipse> holes_;
  std::vector<std::int32_t> hole_of_cell_;  // -1 if the cell has no hole
};

// ---- The points

constexpr double kFirstStep = 0.25;  // nodes; ends of a step with one nearest point have it in between, too
constexpr double kLastStep = 0x1p-20;

class Walk {
 public:
  Walk(const Outline& outline, const std::function<std::uint64_t(GridPosition)>& nearest)
      : outline_(outline), nearest_(nearest) {}

  NumberLoop visits() {
    const double steps = std::ceil(outline_.length / kFirstStep);
    const std::uint64_t first = nearest_(outline_.at(0));
    std::uint64_t last = first;
    for (double step = 1; step <= steps; ++step) {
      const std::uint64_t next = step < steps ? nearest_(outline_.at(step / steps)) : first;
      between((step - 1) / steps, last, step / steps, next);
      last = next;
    }
    return visits_;
  }

 private:
  // Appends the points after the one at `from`, up to and with the one at `to`.
  void between(double from, std::uint64_t there, double to, std::uint64_t next) {
    if (there == next) return;
    if ((to - from) * outline_.length < kLastStep) {
      visits_.push_back(next);
      return;
    }
    const double middle = 0.5 * (from + to);
    const std::uint64_t on_the_way = nearest_(outline_.at(middle));
    between(from, there, middle, on_the_way);
    between(middle, on_the_way, to, next);
  }

  const Outline& outline_;
  const std::function<std::uint64_t(GridPosition)>& nearest_;
  NumberLoop visits_;
};

// Returns the values of `nearest` as its argument goes around the outline, each once, in that order. A value
// that comes back later keeps one visit, and the shorter way from one to the other is left out. At a corner,
// the nearest points of both sides can be one point, and the point in the corner another.
NumberLoop ring_along(const Outline& outline, const std::function<std::uint64_t(GridPosition)>& nearest) {
  return without_returns(Walk(outline, nearest).visits());
}

constexpr std::uint64_t kMostInSquare = 12;  // points of a Poisson process

// The probability that a Poisson number with mean 1 is k or less.
constexpr auto kAtMost = [] {
  std::array<double, kMostInSquare> sums{};
  double term = 0.36787944117144233;  // 1/e
  double sum = 0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sum += term;
    sums[k] = sum;
    term /= static_cast<double>(k + 1);
  }
  return sums;
}();

std::int64_t wrapped(std::int64_t index, std::int64_t size) {
  const std::int64_t rest = index % size;
  return rest < 0 ? rest + size : rest;
}

// In a Poisson process the squares of the grid are independent of each other. Each has a Poisson number of
// points (mean 1), anywhere in the square. Points in a hole are left out. Beyond a density step, only one
// point in `stride` squared stays. A square has at most kMostInSquare points: more would come once in 1.6e10
// squares.
//
// The true loop of a hole is the sequence of points that are nearest to a place on its edge, as the place
// goes around. Distances are measured in the plane of the grid. Neighbours in that sequence share an edge of
// the Delaunay triangulation, and no point lies inside the loop. It encloses the hole, parts of its points'
// Voronoi cells, and empty discs around places on the edge. True loops of outer edges follow the surface's
// edge in the same way.
class RandomPositions : public Positions {
 public:
  // An open side of n nodes has n - 1 squares between them. On panels the nodes are the middles of the
  // squares.
  RandomPositions(const SurfaceGrid& grid, const SurfaceOptions& options)
      : grid_(grid),
        holes_(grid, options),
        rows_(grid.wrap_rows ? grid.rows : grid.rows - 1),
        columns_(grid.wrap_columns ? grid.columns : grid.columns - 1),
        corner_(grid.panels > 1 ? -0.5 : 0),
        count_(options.seed, 3),
        place_(options.seed, 4),
        kept_(options.seed, 5) {}

  std::uint64_t size() const override { return rows_ * columns_ * kMostInSquare; }

  std::optional<GridPosition> at(std::uint64_t number) const override {
    const std::uint64_t square = number / kMostInSquare;
    if (number % kMostInSquare >= points_in(square)) return std::nullopt;
    const GridPosition place{
        corner_ + static_cast<double>(square / columns_) + place_.uniform(2 * number),
        corner_ + static_cast<double>(square % columns_) + place_.uniform(2 * number + 1)};
    if (grid_.stride > 1 && place.column > grid_.step_column &&
        kept_.uniform(number) * grid_.stride * grid_.stride >= 1)
      return std::nullopt;
    if (holes_.takes(place.row, place.column)) return std::nullopt;
    return place;
  }

  std::vector<NumberLoop> true_loops() const override {
    const auto nearest_to = [this](GridPosition place) { return nearest(place); };
    std::vector<NumberLoop> loops;
    for (std::size_t hole = 0; hole < holes_.size(); ++hole)
      loops.push_back(ring_along(holes_.outline(hole), nearest_to));
    for (const Outline& edge : outer_edges(grid_)) loops.push_back(ring_along(edge, nearest_to));
    return loops;
  }

 private:
  std::uint64_t points_in(std::uint64_t square) const {
    const double draw = count_.uniform(square);
    std::uint64_t count = 0;
    while (count < kAtMost.size() && draw >= kAtMost[count]) ++count;
    return count;
  }

  // The squares up to `reach` from the place's own hold all points up to that distance.
  std::uint64_t nearest(GridPosition place) const {
    const auto rows = static_cast<std::int64_t>(rows_), columns = static_cast<std::int64_t>(columns_);
    const auto middle_row = static_cast<std::int64_t>(std::floor(place.row - corner_));
    const auto middle_column = static_cast<std::int64_t>(std::floor(place.column - corner_));
    std::uint64_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t reach = 1; least > static_cast<double>(reach * reach); ++reach) {
      for (std::int64_t row = middle_row - reach; row <= middle_row + reach; ++row) {
        if (!grid_.wrap_rows && (row < 0 || row >= rows)) continue;
        for (std::int64_t column = middle_column - reach; column <= middle_column + reach; ++column) {
          if (!grid_.wrap_columns && (column < 0 || column >= columns)) continue;
          const std::int64_t near_row = wrapped(row, rows), near_column = wrapped(column, columns);
          const auto square = static_cast<std::uint64_t>(near_row * columns + near_column);
          const std::uint64_t end = square * kMostInSquare + points_in(square);
          for (std::uint64_t number = square * kMostInSquare; number < end; ++number) {
            const std::optional<GridPosition> point = at(number);
            if (!point) continue;
            const double down = point->row + static_cast<double>(row - near_row) - place.row;
            const double across = point->column + static_cast<double>(column - near_column) - place.column;
            const double squared = down * down + across * across;
            if (squared >= least) continue;
            least = squared;
            best = number;
          }
        }
      }
    }
    return best;
  }

  SurfaceGrid grid_;
  HoleField holes_;
  std::uint64_t rows_, columns_;  // of squares
  double corner_;                 // row and column of the first square
  Random count_, place_, kept_;
};

// There is one point near each node that no hole takes. A point has the number of its node.
class JitteredPositions : public Positions {
 public:
  JitteredPositions(const SurfaceGrid& grid, const SurfaceOptions& options)
      : grid_(grid), holes_(grid, options), jitter_(options.jitter), place_(options.seed, 1) {}

  std::uint64_t size() const override { return grid_.nodes(); }

  std::optional<GridPosition> at(std::uint64_t node) const override {
    const auto row = static_cast<std::uint32_t>(node / grid_.columns);
    const auto column = static_cast<std::uint32_t>(node % grid_.columns);
    if (!grid_.exists(row, column) || holes_.takes(row, column)) return std::nullopt;
    const double jitter = grid_.thinned(column) ? jitter_ * grid_.stride : jitter_;
    return GridPosition{row + place_.uniform(2 * node, -jitter, jitter),
                        column + place_.uniform(2 * node + 1, -jitter, jitter)};
  }

  std::vector<NumberLoop> true_loops() const override {
    std::vector<NumberLoop> loops = holes_.loops();
    for (NumberLoop& rim : rims(grid_)) loops.push_back(std::move(rim));
    return loops;
  }

 private:
  SurfaceGrid grid_;
  HoleField holes_;
  double jitter_;
  Random place_;
};

}  // namespace

std::unique_ptr<Positions> make_positions(const SurfaceGrid& grid, const SurfaceOptions& options) {
  if (options.positions == PositionKind::kRandom) return std::make_unique<RandomPositions>(grid, options);
  return std::make_unique<JitteredPositions>(grid, options);
}

}  // namespace lacuna::synth
