// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/property_name.hpp"

namespace lacuna::io {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::string known_name(std::string_view given) {
  const std::string lower = lower_case(given);
  for (const char* known : {"x", "y", "z", "nx", "ny", "nz"}) {
    if (lower == known) return lower;
  }
  return std::string(given);
}

std::string property_name(std::string_view given) {
  std::string name = known_name(given);
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
  }
  return name;
}

std::string bare_name(std::string_view name) {
  std::string bare = lower_case(name);
  std::erase_if(bare, [](char c) { return c == '_' || c == ' '; });
  return bare.starts_with("scalar") ? bare.substr(6) : bare;
}

}  // namespace lacuna::io
