// SPDX-License-Identifier: Apache-2.0
// Writing rows to a file: the counterpart of ScanReader.
#pragma once

#include <cstddef>
#include <span>

namespace lacuna::io {

// A file of rows that is being written.
class RowsWriter {
 public:
  virtual ~RowsWriter() = default;
  // Takes whole rows, one after the other. Throws `Error`.
  virtual void put_rows(std::span<const std::byte> rows) = 0;
  // Ends the file; called once, after all rows. Throws `Error`.
  virtual void finish() {}
};

}  // namespace lacuna::io
