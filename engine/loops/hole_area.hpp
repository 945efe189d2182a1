// SPDX-License-Identifier: Apache-2.0
// measure_hole_area: how much surface is missing. Each place counts, and is reported, once.
#pragma once

#include "engine/loops/measure_loops.hpp"
#include "engine/run/job.hpp"

#include <cstddef>
#include <vector>

namespace lacuna {

// Takes out of `selected`, which is ascending, each hole of which three quarters or more lies in larger ones:
// one loop stands for one place. Sets LoopMeasures::own_area of the others, and returns its sum: the area of
// all of them. Where they overlap, a place counts for the largest of them alone. Up to 32 places of each
// hole, spread over its polygon in its plane, are compared with all larger holes. A place is in another hole
// if it is within its polygon, projected along its normal, and near its plane. Near is a quarter of the root
// of the area of the place's own hole. The normals differ by less than 60 degrees. A hole in the surface of
// an island is not in the hole around the island. Memory: 1 kB a hole, beyond a share of the limit on disk.
// Cost: two passes over the holes, and the points of a hole times the places of smaller ones near it.
double measure_hole_area(MeasuredLoops& loops, std::vector<std::size_t>& selected, Job& job);

}  // namespace lacuna
