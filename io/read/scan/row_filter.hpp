// SPDX-License-Identifier: Apache-2.0
// Chooses the rows of a scan that take part, by place and by attributes.
#pragma once

#include "io/read/options/options.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/condition.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

// Which rows were left out. Each is counted by the first filter that refuses it: withheld and noise first,
// then in this order. No filter counts a row that is not finite.
struct FilteredOut {
  std::uint64_t origin = 0;
  std::uint64_t bounds = 0;
  std::uint64_t boxes = 0;
  std::uint64_t withheld = 0;
  std::uint64_t noise = 0;
  std::uint64_t where = 0;
  std::uint64_t synthetic = 0;        // not left out: flagged as synthetic, of the rows that take part
  Eigen::AlignedBox3d bounds_before;  // where there are bounds: of the finite rows that they filter

  std::uint64_t total() const;
};

// What outputs and a workspace need of every filter, in its order.
struct FilterCount {
  std::uint64_t FilteredOut::*count;
  const char* key;     // in JSON
  const char* points;  // that it leaves out, for messages
};
inline constexpr FilterCount kFilterCounts[] = {
    {&FilteredOut::origin, "origin", "without return"},
    {&FilteredOut::bounds, "bounds", "outside of the bounds"},
    {&FilteredOut::boxes, "leave_out", "in boxes that are left out"},
    {&FilteredOut::withheld, "withheld", "withheld"},
    {&FilteredOut::noise, "noise", "of classes 7 and 18, noise"},
    {&FilteredOut::where, "where", "that --where leaves out"}};

inline std::uint64_t FilteredOut::total() const {
  std::uint64_t sum = 0;
  for (const FilterCount& filter : kFilterCounts) sum += this->*filter.count;
  return sum;
}

// Returns the message of an error: which filter left out how many rows, and what these are.
std::string describe_no_row_left(const InputConfig& config, const FilteredOut& filtered);

class RowFilter {
 public:
  // Makes the filter for the rows of one file. Throws `Error` if they lack a column that --where names.
  RowFilter(const InputConfig& config, const std::filesystem::path& file, const ScanReader& reader);

  // Makes the positions of rows that do not take part NaN, and counts them.
  void apply(const RowBatch& rows, std::span<Eigen::Vector3d> positions, FilteredOut& filtered);

 private:
  struct Values {  // of one column, for the rows at hand
    Property property;
    std::vector<double> values;
  };
  void load(const RowBatch& rows, std::optional<Values>& column) const;
  std::uint64_t* refusing(std::size_t row, const Eigen::Vector3d& position, FilteredOut& filtered) const;
  bool is_active_;
  std::size_t stride_;
  std::vector<Eigen::Vector3d> no_return_places_;
  std::optional<Eigen::AlignedBox3d> bounds_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // whose points are left out
  std::optional<Values> withheld_, class_;  // where withheld points or noise are left out
  std::optional<Values> synthetic_;         // where points have this flag
  std::optional<Condition> where_;
};

}  // namespace lacuna::io
