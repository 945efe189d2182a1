// How likely a loop surrounds a hole (method.md, D.3).
#pragma once

namespace lacuna {

// All numbers but the persistence are in [0, 1].
struct TrackEvidence {
  double surface;       // of the loop
  double best;          // largest clearness times surface of the track's loops
  double compactness;   // of the loop
  double sampling_gap;  // `LoopEvidence::sampling_gap`
  double persistence;   // octaves
};

// The logarithm of the odds. Fitted by bench/accuracy/calibrate.py.
double log_odds(const TrackEvidence& evidence);

double probability_of(double log_odds);

}  // namespace lacuna
