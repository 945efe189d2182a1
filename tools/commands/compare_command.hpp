// SPDX-License-Identifier: Apache-2.0
// `lacuna compare`: finds which holes of two results are closed, opened, changed or the same.
#pragma once

#include "tools/matching/compare_loops.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace lacuna::tools {

// The parts of a result that are compared.
struct ComparedResult {
  matching::ComparedScan scan;
  double median_distance = 0;  // of neighbours
  double extent = 0;
  std::string unit;
};
// Reads an output folder of lacuna detect. Throws `Error`.
ComparedResult read_result(const std::filesystem::path& folder);

struct Comparison {
  // `tolerance` is how far apart the curves of one hole may be. 0 means twice the spacing along them, and at
  // least twice the larger median distance of neighbours.
  Comparison(ComparedResult before, ComparedResult after, double tolerance = 0);

  // Returns "2 closed, 1 opened, 14 same; curves of one hole are at most 2 cm apart".
  std::string print_counts() const;
  std::string print_table() const;  // of all but the same holes; empty without any
  nlohmann::ordered_json json() const;

  ComparedResult before, after;
  double tolerance;  // the least
  bool has_places;   // where points are farther apart, curves may be, too
  std::vector<matching::LoopChange> changes;
};

}  // namespace lacuna::tools
