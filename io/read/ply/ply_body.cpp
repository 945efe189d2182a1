// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_body.hpp"

#include "io/read/ply/ply_rows.hpp"

namespace lacuna::io {
namespace {

// A row takes at least so many bytes. ASCII: a digit and a blank for each value.
std::uint64_t least_row_bytes(const PlyElement& element, PlyFormat format) {
  if (format == PlyFormat::kAscii) return 2 * element.properties.size();
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += size_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

}  // namespace

void require_size(const InputFile& in, const PlyHeader& header) {
  const std::uint64_t size = in.position() + in.remaining();
  std::uint64_t left = in.remaining();
  if (header.format == PlyFormat::kAscii) ++left;  // the last line may have no end
  for (const PlyElement& element : header.elements) {
    const std::uint64_t least = least_row_bytes(element, header.format);
    if (least > 0 && element.count > left / least) {
      in.fail_at_byte(size, "the file ends here, too early for the " + std::to_string(element.count) +
                                " rows of element " + in_quotes(element.name) +
                                " that its header declares; it must be complete");
    }
    left -= element.count * least;
  }
}

bool is_swapped(PlyFormat format) {
  return format != PlyFormat::kLittleEndian;
}

void read_rows(InputFile& in, PlyFormat format, const PlyElement& element, std::uint64_t count,
               std::byte* rows) {
  if (format == PlyFormat::kAscii) {
    read_ascii_rows(in, element, count, rows);
  } else {
    read_binary_rows(in, element, is_swapped(format), count, rows);
  }
}

void skip_rows(InputFile& in, PlyFormat format, const PlyElement& element) {
  if (format == PlyFormat::kAscii) {
    skip_ascii_rows(in, element, element.count);
  } else {
    skip_binary_rows(in, element, is_swapped(format), element.count);
  }
}

}  // namespace lacuna::io
