// SPDX-License-Identifier: Apache-2.0
// Rows of scalars as lines of text, divided by commas, with a header line.
#pragma once

#include "io/read/files/output_file.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <span>

namespace lacuna::io {

class CsvWriter final : public RowsWriter {
 public:
  // Writes the header line. Names are changed or quoted where this project's reader, or another, would
  // misread them. The characters ',' ';' '"' and control characters become '_'. A '_' comes before = + - and
  // @ at the start, which are formulas to a spreadsheet. Bytes that are not UTF-8 become U+FFFD. A name that
  // could be a number or a comment is put in quotes. A second equal name gets a number.
  CsvWriter(OutputFile& out, RowLayout layout);

  // Writes rows of the layout, one after the other. Each number is the shortest text that reads back as the
  // same value of its type; `nan` has no sign. Several threads format; the bytes do not depend on them.
  void put_rows(std::span<const std::byte> rows) override;

 private:
  OutputFile& out_;
  RowLayout layout_;
};

}  // namespace lacuna::io
