// SPDX-License-Identifier: Apache-2.0
// The golden results in tests/data: what the plain reference finds in small synthetic clouds. `make_golden`
// writes them anew:
//     ninja -C build make_golden && build/tests/make_golden
// Each cloud is a text file "x y z", each result a text file that says its cloud in its name.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/ids.hpp"
#include "tests/support/clouds.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

struct GoldenCase {
  std::string cloud;
  std::string setting;
  Config config;

  std::string name() const { return cloud + "." + setting; }
};

// Two settings for each cloud and each method.
std::vector<GoldenCase> golden_cases();

// What must come out exactly.
struct GoldenOutcome {
  struct Point {
    std::uint32_t probability = 0;  // in units of 2^-24
    bool coherent = false, boundary = false;

    bool operator==(const Point&) const = default;
  };
  std::vector<Point> points;  // in input order
  std::vector<std::vector<PointId>> loops;
};

GoldenOutcome plain_outcome(const Cloud& cloud, const Config& config);  // by the reference

std::filesystem::path golden_folder();  // tests/data
Cloud read_golden_cloud(const std::string& name);
GoldenOutcome read_golden_outcome(const GoldenCase& golden);

// Draws the clouds and writes all files.
void make_golden();

}  // namespace lacuna
