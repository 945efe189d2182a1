// SPDX-License-Identifier: Apache-2.0
// The criteria: how likely a point is to lie on a boundary, from its neighbourhood (paper, 4.2 to 4.5).
// To add one: write its formula over a `Surface` and its line of the table in `formulas-inl.hpp`.
#pragma once

#include "engine/export.hpp"

#include <string>
#include <vector>

namespace lacuna {

// A line of the table.
struct Criterion {
  std::string name;
  std::string weight_key;  // "weight_NAME", the parameter
  std::string column;      // "scalar_NAME", in PLY
  double default_weight;
  std::string help;  // of the parameter
};

// Returns every criterion, in the order of the table.
LACUNA_API const std::vector<Criterion>& criteria();

// Returns the default weights, in the order of the table.
LACUNA_API std::vector<double> default_weights();

}  // namespace lacuna
