// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/hole_field.hpp"

#include "bench/synth/trig.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace lacuna::synth {

namespace {

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

}  // namespace

HoleField::HoleField(const SurfaceGrid& grid, const SurfaceOptions& options) : grid_(grid) {
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

// A hole is far from the edges of its cell. So a place between two cells may count to either of them.
bool HoleField::takes(double row, double column) const {
  const std::uint32_t down = static_cast<std::uint32_t>(std::max(row, 0.0)) / cell_rows_;
  const auto from_left = static_cast<std::uint32_t>(std::max(column, 0.0));
  const std::uint32_t across = from_left % grid_.panel_columns() / cell_columns_;
  const std::size_t panel = from_left / grid_.panel_columns();
  if (down >= down_ || across >= across_ || panel >= grid_.panels) return false;
  const std::int32_t index = hole_of_cell_[(panel * down_ + down) * across_ + across];
  return index >= 0 && holes_[static_cast<std::size_t>(index)].form(row, column) <= 1;
}

Outline HoleField::outline(std::size_t hole) const {
  const Ellipse& ellipse = holes_[hole];
  // The sum of the squared half axes is the trace of the inverse form.
  const double squares = (ellipse.a + ellipse.c) / (ellipse.a * ellipse.c - ellipse.b * ellipse.b);
  return {kTwoPi * std::sqrt(0.5 * squares), [ellipse](double t) {
            const auto [sin, cos] = sin_cos(t);
            const double scale = 1 / std::sqrt(ellipse.form(ellipse.row + sin, ellipse.column + cos));
            return GridPosition{ellipse.row + scale * sin, ellipse.column + scale * cos};
          }};
}

// Walks from a node of the loop along its boundary edges, never back, until it reaches the node again.
NumberLoop HoleField::trace(const Ellipse& hole) const {
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

std::vector<NumberLoop> HoleField::loops() const {
  std::vector<NumberLoop> all;
  all.reserve(holes_.size());
  for (const Ellipse& hole : holes_) all.push_back(trace(hole));
  return all;
}

}  // namespace lacuna::synth
