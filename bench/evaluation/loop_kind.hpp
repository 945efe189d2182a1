// SPDX-License-Identifier: Apache-2.0
// Whether a true loop goes around a hole or around a piece of surface.
#pragma once

#include "bench/evaluation/loops_reader.hpp"
#include "engine/model/loop.hpp"
#include "io/explain/matching/nearest.hpp"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace lacuna::evaluation {

using matching::PointTree;

// Uses the rule for found loops (engine/loops/measure_loop.hpp): the surface is where the means of the 15
// nearest points are. `points` are the points of the tree, and ids are places in `positions`. Returns nothing
// for fewer than three ids.
std::optional<LoopKind> kind_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions,
                                std::span<const Eigen::Vector3d> points, const PointTree& tree);

}  // namespace lacuna::evaluation
