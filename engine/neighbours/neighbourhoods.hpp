// SPDX-License-Identifier: Apache-2.0
// neighbourhoods: finds the symmetric k-neighbourhoods of a tile's points, widened by the eps ball (paper,
// 4.1).
#pragma once

#include "engine/model/neighbourhoods.hpp"

namespace lacuna {

// List p holds N_p of owned point p, nearest first, ties by id. N_p = { q : q in N_p^{k,eps} or p in
// N_q^{k,eps} }. `points` must hold the owned points and every foreign point that a neighbourhood needs. Some
// foreign points are among the k nearest of an owned one. Others have an owned one among theirs (listed in
// `linked`), or lie within eps. More points do no harm. `eps` is a length; 0: off. Cost: one search per owned
// point, and one more with eps.
Neighbourhoods find_neighbourhoods(const TilePoints& points, std::size_t k, double eps);

}  // namespace lacuna
