// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/length_unit.hpp"

#include "io/read/crs/crs_text.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::io {
namespace {

struct Unit {
  const char* name;
  double metres;
};

constexpr Unit kUnits[] = {{"m", 1},       {"km", 1000},   {"cm", 0.01},
                           {"mm", 0.001},  {"ft", 0.3048}, {"us-ft", 1200.0 / 3937},
                           {"in", 0.0254}, {"yd", 0.9144}};

std::string last_unit(std::string_view system) {
  const std::string_view unit = unit_node(system);
  const std::size_t comma = unit.find(',', unit.find('"', unit.find('"') + 1));
  if (unit.empty() || comma == unit.npos) return "";
  constexpr std::string_view kBlanks = " \t\r\n";
  std::string_view factor = unit.substr(std::min(unit.size(), unit.find_first_not_of(kBlanks, comma + 1)));
  factor = factor.substr(0, factor.find_first_of(" \t\r\n,])"));
  double metres = 0;
  return parse_number(factor, metres) ? unit_of_metres(metres) : "";
}

}  // namespace

std::string unit_of_metres(double metres) {
  constexpr double kTolerance = 1e-7;  // the two feet differ by 2e-6
  const auto* const unit = std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& known) {
    return std::abs(metres / known.metres - 1) < kTolerance;
  });
  return unit == std::end(kUnits) ? "" : unit->name;
}

std::optional<double> metres_of_unit(std::string_view unit) {
  const auto* const known = std::find_if(std::begin(kUnits), std::end(kUnits),
                                         [&](const Unit& other) { return unit == other.name; });
  return known == std::end(kUnits) ? std::nullopt : std::optional(known->metres);
}

std::string length_unit(std::string_view crs) {
  return is_geographic(crs) ? "" : last_unit(horizontal_system(crs));
}

std::string vertical_unit(std::string_view crs) {
  return last_unit(vertical_system(crs));
}

}  // namespace lacuna::io
