// SPDX-License-Identifier: Apache-2.0
// Counts the points of a file by class and kind of return.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace lacuna::tools {

struct AttributeCounts {
  std::uint64_t rows = 0;
  std::map<int, std::uint64_t> classes;  // empty if the file has no property classification
  bool has_returns = false;
  std::uint64_t only = 0, first = 0, later = 0;  // of pulses with one return, and with several
};

// Reads the file to its end, `rows_at_a_time`. Throws `Error`.
AttributeCounts count_attributes(io::ScanReader& reader, std::size_t rows_at_a_time);

// Returns "2 ground 83,412 · 5 high vegetation 20,110", by class; names of ASPRS LAS 1.4 R15, table 17.
std::string print_classes(const AttributeCounts& counts);

// Returns "70,123 only, 20,000 first of several, 19,877 later".
std::string print_returns(const AttributeCounts& counts);

}  // namespace lacuna::tools
