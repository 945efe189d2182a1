// SPDX-License-Identifier: Apache-2.0
// A scan in the memory of another program, as a file of rows.
#pragma once

#include "engine/export.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lacuna::io {

// A scalar of every row, at any stride.
struct ScanColumn {
  std::string name;
  Scalar type;
  const std::byte* first;
  std::ptrdiff_t stride;  // bytes from row to row
};

// The struct does not own the columns.
struct ScanArrays {
  std::uint64_t rows = 0;
  std::vector<ScanColumn> columns;  // x, y and z among them
};

// `arrays` must outlive the reader. Columns are copied row by row.
LACUNA_API std::unique_ptr<ScanReader> read_arrays(const ScanArrays& arrays);

}  // namespace lacuna::io
