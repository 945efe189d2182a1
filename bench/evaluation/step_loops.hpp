// SPDX-License-Identifier: Apache-2.0
// Marks loops along steps of density, where points lie on both sides, much sparser on one.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <span>

#include <Eigen/Core>

namespace lacuna::evaluation {
using namespace matching;

// A false loop becomes a step if `share` of its points are within the tolerance of the edges of steps. It
// becomes joined if `share` of its points are near these edges or a true loop that counts. Without steps,
// nothing changes. Cost: n log n.
void mark_steps(std::span<const LoopIds> loops, std::span<const LoopIds> steps,
                std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions,
                const MatchRule& rule, LoopAccuracy& accuracy);

}  // namespace lacuna::evaluation
