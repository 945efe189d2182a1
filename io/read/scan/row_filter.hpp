// SPDX-License-Identifier: Apache-2.0
// Chooses the rows of a scan that take part, by place, by attributes and by a condition on them.
#pragma once

#include "io/read/options/options.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

// Conditions of attributes, as PDAL has them:
// Classification == 2 and not (ReturnNumber != NumberOfReturns or Withheld == 1).

class Condition {
 public:
  // Names of columns may be in any case, with or without underscores, and in double quotes. `and`, `or` and
  // `not` are also written &&, || and !. A number is rounded to the type of its column. Throws `Error` for
  // text that is no condition, and for a name that fits no column, or several.
  Condition(std::string_view text, const std::string& file, const RowLayout& layout);

  // Loads the columns of these rows; `holds` is about one of them.
  void load(const RowBatch& rows);
  bool holds(std::size_t row) const { return holds(root_, row); }

 private:
  friend class ConditionParser;
  enum class Kind { kEqual, kUnequal, kLess, kLessOrEqual, kGreater, kGreaterOrEqual, kAnd, kOr, kNot };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Node {
    Kind kind;
    // A comparison: of columns a and b, or of column a with the value if b is kNone. Others: of nodes a and
    // b.
    std::size_t a = 0, b = kNone;
    double value = 0;
  };
  struct Column {
    Property property;
    std::vector<double> values;
  };
  bool holds(std::size_t node, std::size_t row) const;

  std::size_t stride_;
  std::vector<Node> nodes_;
  std::vector<Column> columns_;
  std::size_t root_ = 0;
};

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
