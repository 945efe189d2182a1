// SPDX-License-Identifier: Apache-2.0
// How likely a loop is true (method.md, D.3).
#pragma once

#include "engine/model/loop.hpp"

namespace lacuna {

// Returns the logarithm of the odds.
double log_odds(const LoopEvidence& evidence);

double probability_of(double log_odds);

}  // namespace lacuna
