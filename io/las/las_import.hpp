// SPDX-License-Identifier: Apache-2.0
// Rows of other formats as LAS points.
#pragma once

#include "io/las/las_join.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna::io {

// Finds what the values of each column are, and the bounds of the positions that are finite.
class ImportSurvey {
 public:
  // `layout`: of all rows that follow, with x, y and z.
  explicit ImportSurvey(const RowLayout& layout);

  void take(std::span<const std::byte> rows);
  const std::vector<ImportedColumn>& columns() const { return columns_; }
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

 private:
  std::size_t stride_;
  std::vector<ImportedColumn> columns_;
  Eigen::AlignedBox3d bounds_;
};

// `rows` of the layout that the form's imported fields come from. `out`: as with LasTransfer::convert. Sets
// `left_out` to the indices of rows that have no finite position: LAS cannot hold them.
void import_las_rows(const RowLayout& layout, const LasForm& form, std::span<const std::byte> rows,
                     std::size_t stride, std::byte* out, std::vector<std::size_t>& left_out);

}  // namespace lacuna::io
