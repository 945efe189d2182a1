// SPDX-License-Identifier: Apache-2.0
#include "tools/console/measures_text.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/fmt/fmt.h>

namespace lacuna::tools {
namespace {

constexpr int kDigits = 3;
constexpr double kLeastPlain = 1e-3, kMostPlain = 1e15;

std::string print_number(double value) {
  const double size = std::fabs(value);
  if (size != 0 && !(size >= kLeastPlain && size < kMostPlain)) return fmt::format("{:.{}g}", value, kDigits);
  if (size >= 999.5)
    return (value < 0 ? "-" : "") + print_count(static_cast<std::uint64_t>(std::llround(size)));
  // 9.996 has three digits as 10.0.
  int decimals = size > 0 ? kDigits - 1 - static_cast<int>(std::floor(std::log10(size))) : kDigits - 1;
  if (size * std::pow(10, decimals) >= std::pow(10, kDigits) - 0.5) --decimals;
  return fmt::format("{:.{}f}", value, std::max(decimals, 0));
}

std::string with_unit(double value, std::string_view unit, const char* power) {
  std::string text = print_number(value);
  if (!unit.empty()) text.append(" ").append(unit).append(power);
  return text;
}

}  // namespace

std::string counted(std::uint64_t count, std::string_view one, std::string_view several) {
  return print_count(count).append(" ").append(count == 1 ? one : several);
}

std::string print_length(double length, std::string_view unit) {
  return with_unit(length, unit, "");
}

std::string print_area(double area, std::string_view unit) {
  return with_unit(area, unit, "²");
}

std::string print_share(double share) {
  return with_unit(100 * share, "%", "");
}

std::string print_place(const Eigen::Vector3d& place, double extent) {
  constexpr int kMostDecimals = 12;
  const double magnitude = extent > 0 && std::isfinite(extent) ? std::floor(std::log10(extent)) : 0;
  const int decimals = std::clamp(2 - static_cast<int>(magnitude), 0, kMostDecimals);
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    // -0.004 is 0.00, not -0.00.
    const double step = std::pow(10, decimals);
    const double value = std::round(place[axis] * step) / step + 0.0;
    text += (axis > 0 ? " " : "") + fmt::format("{:.{}f}", value, decimals);
  }
  return text;
}

std::string print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (const auto& row : rows) {
    table += "  " + row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) {
      table += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    }
    table += '\n';
  }
  return table;
}

std::string print_count(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

}  // namespace lacuna::tools
