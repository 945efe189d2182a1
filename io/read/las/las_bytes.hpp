// SPDX-License-Identifier: Apache-2.0
// Fields at fixed places in the bytes of a LAS header or record.
#pragma once

#include "io/read/files/little_endian.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace lacuna::io {

template <class T>
void put_at(std::string& bytes, std::size_t offset, T value) {
  store(reinterpret_cast<std::byte*>(&bytes[offset]), value);
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  return load<T>(reinterpret_cast<const std::byte*>(&bytes[offset]));
}

// The text is cut to `length`, or filled with zeros.
inline void put_text(std::string& bytes, std::size_t offset, std::size_t length, std::string_view text) {
  text = text.substr(0, length);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), length, '\0');
  std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

}  // namespace lacuna::io
