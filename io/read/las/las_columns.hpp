// SPDX-License-Identifier: Apache-2.0
// The columns of LAS points, and raw records unpacked to rows.
#pragma once

#include "io/read/las/las_header.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace lacuna::io {

// The columns are every field of the point format, then the extra bytes; x, y and z are doubles in units of
// the scan. Values of extra bytes with a scale or offset, and integers of eight bytes, are doubles. So are
// integers of which a value means no data; that value is NaN. Scan angles are in degrees. Bytes that the
// header does not describe are the columns extra_0, extra_1 and so on. Names differ: a number is added to a
// second one.
class LasColumns {
 public:
  explicit LasColumns(const LasHeader& header);

  const RowLayout& layout() const { return layout_; }
  // `records`: raw ones, one after the other; `rows`: as many of the layout.
  void unpack(std::span<const std::byte> records, std::byte* rows) const;

 private:
  // The place of a column's value in a record, and its conversion.
  struct Source {
    enum class Kind : std::uint8_t { kCoordinate, kBits, kCopy, kScaled } kind;
    std::size_t offset;
    std::uint8_t shift = 0, mask = 0xff;  // of bits
    std::uint8_t stored = 0;              // type of extra bytes, 1 to 10
    double scale = 1, added = 0;
    std::optional<double> no_data = std::nullopt;  // the stored value that becomes NaN
  };
  void add(std::string name, Scalar type, Source source);
  void add_extra(const LasExtraBytes& extra, std::size_t& offset);

  std::size_t record_bytes_;
  RowLayout layout_;
  std::vector<Source> sources_;                         // of each column
  std::unordered_map<std::string, std::size_t> names_;  // of columns, and how many were given each
};

}  // namespace lacuna::io
