#include "io/length_unit.hpp"

#include "io/number.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::io {
namespace {

// `PROJCS[...]` or what it is called since 2015, wherever it stands in a compound system.
std::string_view projected_system(std::string_view crs) {
  for (const std::string_view name : {"PROJCS[", "PROJCRS[", "PROJECTEDCRS[", "LOCAL_CS[", "ENGCRS["}) {
    const std::size_t begin = crs.find(name);
    if (begin == crs.npos) continue;
    std::size_t end = begin + name.size();
    for (int open = 1; end < crs.size() && open > 0; ++end)
      open += crs[end] == '[' ? 1 : crs[end] == ']' ? -1 : 0;
    return crs.substr(begin, end - begin);
  }
  return {};
}

}  // namespace

std::string unit_of_metres(double metres) {
  const auto is = [&](double unit) { return std::abs(metres - unit) < 1e-9; };
  if (is(1)) return "m";
  if (is(0.3048)) return "ft";
  if (is(1200.0 / 3937)) return "us-ft";
  return "";
}

std::string length_unit(std::string_view crs) {
  // Units of angles, and of the geographic system below it, come before the unit of length: the last counts.
  const std::string_view system = projected_system(crs);
  const std::size_t unit = system.rfind("UNIT[\"");
  if (unit == system.npos) return "";
  const std::size_t comma = system.find("\",", unit);
  if (comma == system.npos) return "";
  std::string_view factor = system.substr(comma + 2);
  factor = factor.substr(0, std::min(factor.size(), factor.find_first_of(",]")));
  while (factor.starts_with(' ')) factor.remove_prefix(1);
  double metres = 0;
  return parse_number(factor, metres) ? unit_of_metres(metres) : "";
}

}  // namespace lacuna::io
