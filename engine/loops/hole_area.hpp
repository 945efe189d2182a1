// SPDX-License-Identifier: Apache-2.0
// measure_hole_area: how much surface is missing, each place once.
#pragma once

#include "engine/loops/measure_loops.hpp"
#include "engine/run/parallel.hpp"

#include <cstddef>
#include <span>

namespace lacuna {

// Sets LoopMeasures::own_area of the selected holes, and returns its sum: the area of all of them. Where they
// overlap, a place counts for the largest of them alone. Up to 32 places of each hole, spread over its
// polygon in its plane, are compared with all larger holes. A place is in another hole if it is within its
// polygon, projected along its normal, and near its plane. Near is a quarter of the root of the area of the
// place's own hole. The normals differ by less than 60 degrees. Memory: 1 kB a hole, beyond a fraction of the
// limit on disk. Cost: two passes over the holes, and the points of a hole times the places of smaller ones
// near it.
double measure_hole_area(MeasuredLoops& loops, std::span<const std::size_t> selected, const Spill& spill,
                         const Workers& workers);

}  // namespace lacuna
