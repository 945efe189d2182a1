// SPDX-License-Identifier: Apache-2.0
// Values at any byte of a record, in the byte order of LAS files.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace lacuna::io {

static_assert(std::endian::native == std::endian::little, "LAS records are copied as they are in memory");

template <class T>
requires std::is_trivially_copyable_v<T> T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
requires std::is_trivially_copyable_v<T>
void store(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

// Stores a value, and moves `to` behind it.
template <class T>
void store_next(std::byte*& to, T value) {
  store(to, value);
  to += sizeof value;
}

}  // namespace lacuna::io
