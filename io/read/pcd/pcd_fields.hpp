// SPDX-License-Identifier: Apache-2.0
// The properties of rows that the fields of a PCD file become.
#pragma once

#include "io/read/pcd/pcd_header.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna::io {

// Calls `visit(T{})` with the C++ type of the field's values.
template <class Visit>
void with_pcd_type(const PcdField& field, const Visit& visit) {
  if (field.type == 'F') return field.size == 4 ? visit(float{}) : visit(double{});
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? visit(std::int8_t{}) : visit(std::uint8_t{});
    case 2:
      return is_signed ? visit(std::int16_t{}) : visit(std::uint16_t{});
    case 4:
      return is_signed ? visit(std::int32_t{}) : visit(std::uint32_t{});
    default:
      return is_signed ? visit(std::int64_t{}) : visit(std::uint64_t{});
  }
}

// Throws `Error` unless names differ and x, y and z are among them.
RowLayout pcd_layout(const InputFile& in, const PcdHeader& header);

// Converts `batch.count` rows from the header's form, in the machine's byte order, to rows of the layout.
void convert_pcd_rows(const PcdHeader& header, const std::byte* raw, const RowLayout& layout,
                      RowBatch& batch);

}  // namespace lacuna::io
