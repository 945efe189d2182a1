// What a person reads after a run.
#pragma once

#include "engine/model/detection.hpp"
#include "io/file_scan.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lacuna {

struct RunTimes {
  double write_seconds = 0;
  double total_seconds = 0;
};

// What was read and found, time per phase, and the loops, the one with the largest perimeter first.
std::string print_summary(const Detection& detection, const FileScan& scan, const RunTimes& times);

// Points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const FilteredOut& filtered);

// Rows of as many cells each, at least one row; columns as wide as their widest cell, the first to the left,
// the others to the right.
std::string print_table(const std::vector<std::vector<std::string>>& rows);

std::string print_count(std::uint64_t count);  // "1,234,567"
std::string print_size(std::uint64_t bytes);   // "1.5 GiB", for people; exact: print_bytes
std::uint64_t peak_memory();                   // bytes resident, as the operating system measures it

}  // namespace lacuna
