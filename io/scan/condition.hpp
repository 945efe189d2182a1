// SPDX-License-Identifier: Apache-2.0
// Conditions of attributes, as PDAL has them: Classification == 2 and not (ReturnNumber > 1 or Withheld ==
// 1).
#pragma once

#include "io/rows/scan_reader.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

class Condition {
 public:
  // Names of columns may be in any case, with or without underscores. `and`, `or` and `not` are also written
  // &&, || and !. Throws `Error` for text that is no condition, and for a name that is no column.
  Condition(std::string_view text, const std::string& file, const RowLayout& layout);

  // Loads the columns of these rows; `holds` is about one of them.
  void load(const RowBatch& rows);
  bool holds(std::size_t row) const { return holds(root_, row); }

 private:
  friend class ConditionParser;
  enum class Kind { kEqual, kUnequal, kLess, kLessOrEqual, kGreater, kGreaterOrEqual, kAnd, kOr, kNot };
  struct Node {
    Kind kind;
    std::size_t column = 0;    // of a comparison
    double value = 0;          // of a comparison
    std::size_t a = 0, b = 0;  // nodes of the others
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
