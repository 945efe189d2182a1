#include "io/property_name.hpp"

namespace lacuna {

std::string known_name(std::string_view given) {
  std::string lower(given);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
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

}  // namespace lacuna
