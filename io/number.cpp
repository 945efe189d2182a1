#include "io/number.hpp"

#include <cstdlib>

namespace lacuna {

float parse_extreme(std::string_view text, float) {
  return std::strtof(std::string(text).c_str(), nullptr);
}

double parse_extreme(std::string_view text, double) {
  return std::strtod(std::string(text).c_str(), nullptr);
}

}  // namespace lacuna
