// SPDX-License-Identifier: Apache-2.0
// Results of every point of a thinned scan: each point has the results of its representative.
#pragma once

#include "engine/model/detection.hpp"
#include "engine/run/memory.hpp"
#include "engine/thin/choose_points.hpp"

#include <memory>

namespace lacuna {

// The detection on the representatives, with result blocks of all points of the input. Everything else is of
// representatives alone. Cost: one sort of all points on disk when the blocks are read. With results.points
// only.
std::unique_ptr<Detection> spread_results(std::unique_ptr<Detection> detection,
                                          AppendLists<Represented> represented, const Spill& spill);

}  // namespace lacuna
