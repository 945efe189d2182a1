// SPDX-License-Identifier: Apache-2.0
#include "io/read/ply/ply_rows.hpp"
#include "io/read/rows/scalar.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace lacuna::io {
namespace {

template <class T>
T read_value(InputFile& in, bool swapped) {
  std::array<std::byte, sizeof(T)> bytes;
  in.read(bytes.data(), bytes.size());
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), bytes.size());
  return value;
}

// Returns at most 2^32 - 1.
std::uint64_t read_count(InputFile& in, const PlyProperty& property, bool swapped) {
  const std::uint64_t place = in.position();
  return with_type(*property.count_type, [&](auto zero) -> std::uint64_t {
    const auto value = read_value<decltype(zero)>(in, swapped);
    if (value < 0) in.fail_at_byte(place, "list " + in_quotes(property.name) + " has a negative count");
    return static_cast<std::uint64_t>(value);
  });
}

void skip_list(InputFile& in, const PlyProperty& property, bool swapped) {
  in.skip(read_count(in, property, swapped) * size_of(property.type));
}

void read_list(InputFile& in, const PlyProperty& property, bool swapped, std::vector<std::int64_t>& values) {
  const std::uint64_t count = read_count(in, property, swapped);
  const std::uint64_t bytes = count * size_of(property.type);
  if (bytes > in.remaining()) in.skip(bytes);  // says what is missing
  values.clear();
  values.reserve(count);
  with_type(property.type, [&](auto zero) {
    for (std::uint64_t i = 0; i < count; ++i) {
      values.push_back(static_cast<std::int64_t>(read_value<decltype(zero)>(in, swapped)));
    }
  });
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

void visit_binary_lists(InputFile& in, const PlyElement& element, bool swapped, std::size_t list,
                        const ListVisitor& visit) {
  std::vector<std::int64_t> values;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i == list) {
        read_list(in, property, swapped, values);
      } else if (property.count_type) {
        skip_list(in, property, swapped);
      } else {
        in.skip(size_of(property.type));
      }
    }
    visit(values);
  }
}

}  // namespace lacuna::io
