// SPDX-License-Identifier: Apache-2.0
// Conditions of attributes, as PDAL has them:
// Classification == 2 and not (ReturnNumber != NumberOfReturns or Withheld == 1).
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

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

}  // namespace lacuna::io
