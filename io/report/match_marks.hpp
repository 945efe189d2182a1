// SPDX-License-Identifier: Apache-2.0
// Finds the loop of a result that each mark belongs to.
#pragma once

#include "io/loops/json.hpp"
#include "io/report/marks.hpp"
#include "io/report/scene.hpp"

#include <span>

namespace lacuna::io {

// Finds marks again in a result with other ids. A mark and its loop have one kind, and a loop has one mark.
// 1. In the order of marks: the loop with its id, if its centroid is no farther than the smaller diameter.
// 2. The other marks, the nearest pairs first: centroids are within half of the mark's diameter. Diameters
//    differ by a factor of 1.5 at most. Equally near pairs go in the order of marks, then of loops.
// Cost: the product of the numbers of marks and loops.
MarkMatches match_marks(std::span<const LoopMark> marks, const Scene::Loops& loops);

// Returns the data that the page reads: ids, marks and notes of matched loops, and the others as in the file.
Json marks_json(const MatchedMarks& marks, const Scene::Loops& loops);

}  // namespace lacuna::io
