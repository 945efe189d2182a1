// SPDX-License-Identifier: Apache-2.0
// Golden results of real scans, made by another program. They lie next to the checkout, in the shared folder;
// tests are skipped where that is absent. Those of synthetic clouds: made_golden.hpp.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/ids.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

// $LACUNA_SHARED, else `shared` next to the source folder. Where that is no folder: none, and the running
// test case is skipped.
std::optional<fs::path> shared_folder();

struct GoldenPoint {
  double angle = 0, halfdisc = 0, shape = 0, probability = 0;
  bool coherent = false;
};

using GoldenLoops = std::vector<std::vector<PointId>>;  // sorted

struct GoldenSetting {
  std::string name;   // of its files in shared/golden
  std::string cloud;  // file in the shared folder
  Config config;
};

// All seven.
std::vector<GoldenSetting> golden_settings();

std::vector<GoldenPoint> read_golden_points(const fs::path& shared, const GoldenSetting& setting);
GoldenLoops read_golden_loops(const fs::path& shared, const GoldenSetting& setting);

// A scan in any format of io/, with its normals if it has them.
Cloud read_cloud(const fs::path& file);

}  // namespace lacuna
