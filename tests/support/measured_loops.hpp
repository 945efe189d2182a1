// SPDX-License-Identifier: Apache-2.0
// Loops that are drawn by a test, with their measures.
#pragma once

#include "engine/loops/measure_loops.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

struct DrawnLoop {
  std::vector<Eigen::Vector3d> points;
  LoopKind kind = LoopKind::kHole;
};

// A square, with `on_side` points from a corner to the next.
DrawnLoop square(double half, LoopKind kind, const Eigen::Vector3d& centre = {0, 0, 0}, int on_side = 5);

MeasuredLoops measured(std::span<const DrawnLoop> drawn, const std::filesystem::path& folder);

}  // namespace lacuna::test
