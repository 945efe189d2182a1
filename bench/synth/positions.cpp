// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/positions.hpp"

#include "bench/synth/random_positions.hpp"

#include <utility>

namespace lacuna::synth {

namespace {

// There is one point near each node that no hole takes. A point has the number of its node.
class JitteredPositions : public Positions {
 public:
  JitteredPositions(const SurfaceGrid& grid, const HoleField& holes, const SurfaceOptions& options)
      : grid_(grid), holes_(holes), jitter_(options.jitter), place_(options.seed, 1) {}

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
  const SurfaceGrid& grid_;
  const HoleField& holes_;
  double jitter_;
  Random place_;
};

}  // namespace

std::unique_ptr<Positions> make_positions(const SurfaceGrid& grid, const HoleField& holes,
                                          const SurfaceOptions& options) {
  if (options.positions == PositionKind::kRandom)
    return std::make_unique<RandomPositions>(grid, holes, options);
  return std::make_unique<JitteredPositions>(grid, holes, options);
}

}  // namespace lacuna::synth
