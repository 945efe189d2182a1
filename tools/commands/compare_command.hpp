// SPDX-License-Identifier: Apache-2.0
// `lacuna compare`: finds which holes of two results are closed, opened, changed or the same.
#pragma once

#include "io/explain/matching/compare_loops.hpp"
#include "io/write/report/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace lacuna::tools {

// The parts of a result that are compared.
struct ComparedResult {
  std::filesystem::path folder;
  matching::ComparedScan scan;
  double median_distance = 0;  // of neighbours
  double extent = 0;
  Eigen::Vector3d middle{0, 0, 0};  // of its bounds
  std::string unit, crs;            // empty: not stated
};
// Reads an output folder of lacuna detect. Throws `Error`.
ComparedResult read_result(const std::filesystem::path& folder);

struct Comparison {
  // The first result is brought into the unit of the second one, where both state one. `tolerance` is in that
  // unit. It is how far apart the curves of one hole may be. 0 means twice the spacing along them, and at
  // least twice the larger median distance of neighbours. Throws `Error` where the systems differ.
  Comparison(ComparedResult before, ComparedResult after, double tolerance = 0);

  // Returns "2 closed, 1 opened, 14 same; curves of one hole are at most 2 cm apart".
  std::string print_counts() const;
  std::string print_table() const;  // of all but the same holes; empty without any
  nlohmann::ordered_json json() const;

  // Gives the loops of the second result their changes, and adds those that only the first one has. Their ids
  // come after all ids of the second result.
  void show_in(io::Scene& scene) const;

  ComparedResult before, after;
  std::vector<std::string> warnings;  // lines: what may be wrong, as a side states neither unit nor system
  double tolerance;                   // the least
  bool has_places;                    // where points are farther apart, curves may be, too
  std::vector<matching::LoopChange> changes;

 private:
  void bring_together();
};

}  // namespace lacuna::tools
