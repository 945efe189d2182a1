// SPDX-License-Identifier: Apache-2.0
// evaluate: finds normals and criteria of a tile's points (paper, 4.2 to 4.6).
#pragma once

#include "engine/config/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/neighbourhoods.hpp"

#include <span>
#include <vector>

namespace lacuna {

// Returns one evaluation per owned point, from its neighbourhood. `given_normals`: one per owned point, or
// empty; a zero or non-finite normal is estimated, and by default one that is off (NormalsUse). Degenerate
// points get the values of the method, section 3. `values` takes the criteria of one owned point after the
// other, in the order of the table. It is empty where they are not wanted.
std::vector<Evaluation> evaluate(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                                 std::span<const Eigen::Vector3d> given_normals, const NormalsConfig& normals,
                                 const CriteriaConfig& criteria, std::span<double> values = {});

// Pi, w_density and w_total are multiples of this step. So rounding noise decides no tie, and a 32-bit float
// holds Pi exactly.
inline constexpr double kProbabilityStep = 1.0 / (1 << 24);
double round_to_step(double value);  // ties to even

}  // namespace lacuna
