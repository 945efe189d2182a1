#include "io/ply_rows.hpp"
#include "io/scalar.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace lacuna {
namespace {

void skip_list(InputFile& in, const PlyProperty& property, bool swapped) {
  const std::uint64_t place = in.position();
  const std::uint64_t count = with_type(*property.count_type, [&](auto value) -> std::uint64_t {
    std::array<std::byte, sizeof(value)> bytes;
    in.read(bytes.data(), bytes.size());
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), bytes.size());
    if (value < 0) in.fail_at_byte(place, "list " + in_quotes(property.name) + " has a negative count");
    return static_cast<std::uint64_t>(value);
  });
  in.skip(count * size_of(property.type));  // at most 2^32 times 8
}

}  // namespace

void read_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count,
                      std::byte* rows) {
  const RowLayout layout = element.layout();
  if (!element.has_lists()) {
    in.read(rows, count * layout.stride);
  } else {
    std::byte* to = rows;
    for (std::uint64_t row = 0; row < count; ++row) {
      for (const PlyProperty& property : element.properties) {
        if (property.count_type) {
          skip_list(in, property, swapped);
        } else {
          in.read(to, size_of(property.type));
          to += size_of(property.type);
        }
      }
    }
  }
  if (!swapped) return;
  for (const Property& property : layout.properties) {
    swap_bytes({.data = rows + property.offset, .stride = layout.stride, .type = property.type}, count);
  }
}

void skip_binary_rows(InputFile& in, const PlyElement& element, bool swapped, std::uint64_t count) {
  if (!element.has_lists()) {
    in.skip(count * element.layout().stride);  // cannot overflow: require_size has seen the count
    return;
  }
  for (; count > 0; --count) {
    for (const PlyProperty& property : element.properties) {
      if (property.count_type) {
        skip_list(in, property, swapped);
      } else {
        in.skip(size_of(property.type));
      }
    }
  }
}

}  // namespace lacuna
