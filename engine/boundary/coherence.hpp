// SPDX-License-Identifier: Apache-2.0
// coherence: a candidate stays boundary only while both of its gap neighbours are (paper, 5.1).
#pragma once

#include "engine/store/row_set.hpp"

#include <span>

namespace lacuna {

// A candidate that has gap neighbours; without any it is none.
struct Candidate {
  Row row;
  Row gap_near, gap_far;
};

// Takes candidates off the boundary until each remaining one has both of its gap neighbours on it.
// `candidates` in ascending row; only their own bits are changed. True if any was taken off. Repeated over
// parts of a scan, in any order, until no part changes, this gives the greatest fixed point of the whole.
// Cost: linear in the candidates and the rows between the first and the last of them.
bool remove_incoherent(std::span<const Candidate> candidates, RowSet& boundary);

}  // namespace lacuna
