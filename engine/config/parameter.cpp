// SPDX-License-Identifier: Apache-2.0
#include "engine/config/parameter.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include <toml++/toml.h>

namespace lacuna {
namespace {

constexpr std::uint64_t kKiB = 1024;
constexpr std::uint64_t kMiB = 1024 * kKiB;
constexpr std::uint64_t kGiB = 1024 * kMiB;
constexpr std::uint64_t kTiB = 1024 * kGiB;

struct Unit {
  std::string_view name;
  std::uint64_t bytes;
};

constexpr Unit kUnits[] = {
    {"TiB", kTiB},         {"GiB", kGiB},     {"MiB", kMiB}, {"KiB", kKiB}, {"TB", 1'000'000'000'000},
    {"GB", 1'000'000'000}, {"MB", 1'000'000}, {"KB", 1'000}, {"kB", 1'000}, {"B", 1},
};

template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

bool in_range(const Parameter& parameter, double value) {
  if (is_any_of<std::uint64_t*>(parameter) && value == 0) return true;
  return std::isfinite(value) && parameter.min <= value && value <= parameter.max;
}

// Sets the value, of whatever type the parameter has, and returns true if the text is a possible one.
struct SetFromText {
  const Parameter& parameter;
  std::string_view text;

  template <typename Number>
  bool operator()(Number* target) const {
    return set(target, parse_number<Number>(text));
  }
  bool operator()(std::uint64_t* target) const { return set(target, parse_bytes(text)); }
  bool operator()(bool* target) const {
    if (text != "true" && text != "false") return false;
    *target = text == "true";
    return true;
  }
  bool operator()(std::string* target) const {
    *target = text;
    return true;
  }
  bool operator()(std::vector<double>* target) const {
    std::vector<double> numbers;
    constexpr std::string_view kBetween = ", \t";
    for (std::size_t at = text.find_first_not_of(kBetween); at < text.size();) {
      const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
      if (!set(&numbers.emplace_back(), parse_number<double>(text.substr(at, end - at)))) return false;
      at = text.find_first_not_of(kBetween, end);
    }
    *target = std::move(numbers);
    return true;
  }
  bool operator()(const NamedValue& target) const {
    const auto name = std::find(target.names.begin(), target.names.end(), text);
    if (name == target.names.end()) return false;
    *target.value = static_cast<std::uint8_t>(name - target.names.begin());
    return true;
  }

 private:
  template <typename Number>
  bool set(Number* target, std::optional<Number> number) const {
    if (!number || !in_range(parameter, static_cast<double>(*number))) return false;
    *target = *number;
    return true;
  }
};

struct PrintValue {
  std::string operator()(const std::int64_t* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return print_number(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return quote(*value); }
  std::string operator()(const std::uint64_t* value) const { return quote(print_bytes(*value)); }
  std::string operator()(const std::vector<double>* values) const {
    std::string text;
    for (const double value : *values) text += (text.empty() ? "" : ", ") + (*this)(&value);
    return "[" + text + "]";
  }
  std::string operator()(const NamedValue& value) const { return quote(value.names[*value.value]); }
};

}  // namespace

[[noreturn]] void refuse(const Parameter& parameter, std::string_view given) {
  std::ostringstream message;
  message << parameter.key << " = " << given << " is not possible; allowed: " << parameter.allowed;
  if (is_any_of<double*, std::vector<double>*>(parameter) && !parse_number<double>(given))
    message << ", as a number without a unit, with a decimal point";
  throw UsageError(message.str());
}

void check_ranges(const std::vector<Parameter>& all) {
  for (const Parameter& parameter : all) {
    std::visit(
        [&parameter](const auto& value) {
          if constexpr (requires { static_cast<double>(*value); }) {
            if (!in_range(parameter, static_cast<double>(*value))) refuse(parameter, parameter.print());
          }
        },
        parameter.value);
  }
}

std::string print_number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string text(buffer, end);
  const bool is_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return is_whole ? text + ".0" : text;
}

std::string quote(std::string_view text) {
  std::ostringstream quoted;
  quoted << toml::toml_formatter{toml::value{text}, toml::format_flags::allow_unicode_strings};
  return quoted.str();
}

std::string Parameter::option() const {
  std::string name = "--" + std::string(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string Parameter::print() const {
  return std::visit(PrintValue{}, value);
}

void Parameter::set(std::string_view text) const {
  if (std::visit(SetFromText{*this, text}, value)) return;
  refuse(*this, text);
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const auto number = parse_number<std::uint64_t>(text.substr(0, digits));
  std::string_view name = text.substr(digits);
  if (name.starts_with(' ')) name.remove_prefix(1);
  const Unit* unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [name](const Unit& known) { return known.name == name; });
  if (!number || (unit == std::end(kUnits) && digits != text.size())) return std::nullopt;

  const std::uint64_t factor = unit == std::end(kUnits) ? 1 : unit->bytes;
  if (*number > std::numeric_limits<std::uint64_t>::max() / factor) return std::nullopt;
  return *number * factor;
}

std::string print_bytes(std::uint64_t bytes) {
  for (const Unit& unit : kUnits) {
    const bool is_binary = unit.name.size() == 3;
    if (is_binary && bytes > 0 && bytes % unit.bytes == 0) {
      return std::to_string(bytes / unit.bytes) + std::string(unit.name);
    }
  }
  return std::to_string(bytes);
}

}  // namespace lacuna
