// SPDX-License-Identifier: Apache-2.0
// nest_loops: which loops are inside others, and how much surface is missing, each place once (method.md,
// D.6).
//
// Idea: a loop is a polygon in its plane, and a few samples of each smaller loop near it decide. Points of
// the smaller loop say what is inside, places of a smaller hole say what counts twice. Pairs are found by the
// centroids of loops, and each polygon is passed once.
//
// Source: places follow the additive recurrence with the plastic number (Roberts, 2018); the rest is Lacuna's
// own. Cost: a few passes over the loops, and the points of a loop times the samples of smaller ones near it.
// Memory: 1 kB a loop, beyond a fraction of the limit on disk.
#pragma once

#include "engine/loops/measure_loops.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna {

// Sets `parent` of each loop to the smallest loop around it, if this is of the other kind. Then takes the
// areas of islands from the areas of holes, projected along the hole's normal. An island is an outer curve
// whose parent is the hole.
//
// A loop is around another one if it is larger and their normals differ by less than 60 degrees. Nine in ten
// points of the other loop, of up to 32, are within its polygon, projected along its normal. There the slope
// from the nearest edge is less than 45 degrees. The edge is searched along a line through the point. So what
// hides a surface from above, such as a table, is no island in the hole below. The smallest
// loop may be more than two spacings up or down. Then a larger one at half that height is the parent: it is
// of the same sheet.
//
// Ties: by order. A loop that encloses no area has no parent and is none. Memory: 1 kB a loop, beyond a
// fraction of the limit on disk. Cost: a pass over the loops, and over each loop with others near its inside.
void nest_loops(MeasuredLoops& loops, const Spill& spill, const Workers& workers, Phases& phases);

// Loops as they are reported.
struct NestedReport {
  std::vector<LoopMeasures> loops;                  // the parent is a reported loop, or -1
  std::vector<std::vector<InnerRing>> inner_rings;  // of each
  std::vector<std::size_t> found;                   // of each number in a ring: the found loop
};

// `selected`: ascending. An island of a reported hole is an inner ring even if it is not selected. A hole is
// one only if it is.
NestedReport report_nested(const std::vector<LoopMeasures>& found, std::vector<std::size_t> selected);

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
