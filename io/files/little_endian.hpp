// SPDX-License-Identifier: Apache-2.0
// Numbers at any byte of a record, in the byte order of LAS files.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace lacuna::io {

static_assert(std::endian::native == std::endian::little, "LAS records are copied as they are in memory");

template <class T>
requires std::is_arithmetic_v<T> T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
requires std::is_arithmetic_v<T>
void store(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

}  // namespace lacuna::io
