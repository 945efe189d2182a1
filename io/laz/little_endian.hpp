// Numbers in the byte order of LAS files.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstring>

namespace lacuna::laz {

static_assert(std::endian::native == std::endian::little, "LAS records are copied as they are in memory");

template <std::integral T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <std::integral T>
void store(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

}  // namespace lacuna::laz
