// SPDX-License-Identifier: Apache-2.0
// How likely a loop surrounds a hole (method.md, D.3).
#pragma once

namespace lacuna {

// All numbers but the width and the persistence are in [0, 1].
struct TrackEvidence {
  double clearness;     // `LoopEvidence`
  double surface;       // likewise
  double sampling_gap;  // likewise
  double width;         // of the loop, in spacings
  double roundness;     // of the loop
  double best;          // largest clearness times surface of the track's loops
  double persistence;   // octaves
  bool is_first_level;  // the loop was found at the first level
};

// Small for scribbles and slits of the sampling: the loop's area over the area of the circle with the same
// perimeter. A long hole has up to a half. It reaches its full value at a width of eight spacings.
double roundness(double perimeter, double area, double width);

// Returns the logarithm of the odds.
double log_odds(const TrackEvidence& evidence);

double probability_of(double log_odds);

}  // namespace lacuna
