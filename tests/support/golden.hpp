// SPDX-License-Identifier: Apache-2.0
// The golden results in tests/data/golden.txt: what the plain reference finds in small drawn clouds.
// `make_golden` writes them anew:
//     ninja -C build make_golden && build/tests/make_golden
// Each line has the name of a case and one of its findings: a loop, or the digest of all that is of one kind.
// So a line that differs says what has changed.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/ids.hpp"
#include "tests/support/clouds.hpp"

#include <string>
#include <vector>

namespace lacuna {

struct GoldenCase {
  std::string name;
  Cloud cloud;
  Config config;
};

// Two settings for each cloud and each method.
std::vector<GoldenCase> golden_cases();

struct GoldenOutcome {
  struct Loop {
    std::vector<PointId> points;
    double confidence = 0;
  };
  struct Point {
    double probability = 0;
    bool coherent = false, boundary = false;
  };
  std::vector<Point> points;  // in input order
  std::vector<Loop> loops;    // in any order
};

// The lines of a case. Probabilities count to 2^-24, confidences to three decimals.
std::string golden_lines(const GoldenCase& golden, GoldenOutcome outcome);

inline const std::string kGoldenFile = "tests/data/golden.txt";  // in the checkout

}  // namespace lacuna
