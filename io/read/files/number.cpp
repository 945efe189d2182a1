// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <locale.h>
#include <spdlog/fmt/fmt.h>

namespace lacuna::io {

namespace {

// This locale has the decimal point, whatever the host has set.
locale_t plain_locale() {
  static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return plain;
}

}  // namespace

float parse_extreme(std::string_view text, float) {
  return ::strtof_l(std::string(text).c_str(), nullptr, plain_locale());
}

double parse_extreme(std::string_view text, double) {
  return ::strtod_l(std::string(text).c_str(), nullptr, plain_locale());
}

std::string describe_whole_number(std::int64_t least, std::uint64_t most) {
  return "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
}

double reread(double value, std::chars_format format, int digits) {
  if (!std::isfinite(value)) return value;
  std::array<char, 800> text;
  const char* const end = std::to_chars(text.data(), text.data() + text.size(), value, format, digits).ptr;
  parse_number({text.data(), end}, value);
  return value;
}

std::string print_point(const Eigen::Vector3d& point) {
  return fmt::format("{:.10g} {:.10g} {:.10g}", point.x(), point.y(), point.z());
}

int place_decimals(double distance) {
  return distance > 0 ? static_cast<int>(std::clamp(std::ceil(3 - std::log10(distance)), 0.0, 300.0)) : 17;
}

bool parse_foreign_number(std::string_view text, double& value) {
  constexpr std::size_t kLongest = 100;
  if (text.size() > kLongest) return false;
  if (const std::size_t sharp = text.find("1.#");
      sharp <= 1 && text.substr(0, sharp).find_first_not_of("+-") == text.npos) {
    const std::string_view kind = text.substr(sharp + 3);
    const bool is_infinite = kind.starts_with("INF");
    if (!is_infinite && !kind.starts_with("QNAN") && !kind.starts_with("SNAN") && !kind.starts_with("IND"))
      return false;
    value = is_infinite ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    if (text.front() == '-') value = -value;
    return true;
  }
  std::string plain(text);
  if (std::count(plain.begin(), plain.end(), ',') > 1) return false;
  for (char& c : plain) {
    if (c == ',') c = '.';
    if (c == 'D' || c == 'd') c = 'e';
  }
  return parse_number(plain, value);
}

}  // namespace lacuna::io
