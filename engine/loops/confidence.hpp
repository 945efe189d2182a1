// SPDX-License-Identifier: Apache-2.0
// How likely a loop is true (method.md, D.3).
#pragma once

#include "engine/model/loop.hpp"

namespace lacuna {

// Returns the logarithm to the base 2, by straight lines between powers of two: within 0.09, and the same on
// every machine.
double octaves(double ratio);

// Returns the logarithm of the odds.
double log_odds(const LoopEvidence& evidence);

// Returns whether some prominence and track would make the loop more likely true than false, with nothing
// beyond it.
bool could_be_probable(LoopEvidence evidence);

// Whether the loop has a chance, however long its track is. Other loops are compared with none.
bool could_be_tracked(LoopEvidence evidence);

double probability_of(double log_odds);

}  // namespace lacuna
