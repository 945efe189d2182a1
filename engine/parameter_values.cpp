#include "engine/parameter_values.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace lacuna {
namespace {

constexpr std::uint64_t kKiB = 1024;
constexpr std::uint64_t kMiB = 1024 * kKiB;
constexpr std::uint64_t kGiB = 1024 * kMiB;
constexpr std::uint64_t kTiB = 1024 * kGiB;

constexpr std::string_view kFormerTangential = "stars";

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

// Sets values, of whatever type the parameter has, once they are found possible.
struct SetFromText {
  const Parameter& parameter;
  std::string_view text;

  template <typename Number>
  void operator()(Number* target) const {
    const std::optional<Number> number = parse_number<Number>(text);
    if (!number || !in_range(parameter, static_cast<double>(*number))) refuse(parameter, text);
    *target = *number;
  }
  void operator()(bool* target) const {
    if (text != "true" && text != "false") refuse(parameter, text);
    *target = text == "true";
  }
  void operator()(std::string* target) const { *target = text; }
  template <typename Number>
  void operator()(std::vector<Number>* target) const {
    std::vector<Number> numbers;
    constexpr std::string_view kBetween = ", \t";
    for (std::size_t at = text.find_first_not_of(kBetween); at < text.size();) {
      const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
      const std::optional<Number> number = parse_number<Number>(text.substr(at, end - at));
      if (!number || !in_range(parameter, static_cast<double>(*number))) refuse(parameter, text);
      numbers.push_back(*number);
      at = text.find_first_not_of(kBetween, end);
    }
    *target = std::move(numbers);
  }
  void operator()(const NamedValue& target) const {
    const auto name = std::find(target.names.begin(), target.names.end(), text);
    if (name == target.names.end()) {
      const bool is_method = parameter.key == "method";
      refuse(parameter, is_method && text == kFormerTangential ? "stars (now called tangential)" : text);
    }
    *target.value = static_cast<std::uint8_t>(name - target.names.begin());
  }
  void operator()(std::uint64_t* target) const {
    std::uint64_t bytes = 0;
    try {
      bytes = parse_bytes(text);
    } catch (const Error&) {
      refuse(parameter, text);
    }
    if (!in_range(parameter, static_cast<double>(bytes))) refuse(parameter, text);
    *target = bytes;
  }
};

struct PrintValue {
  std::string operator()(const std::int64_t* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return print_number(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return quote(*value); }
  std::string operator()(const std::uint64_t* value) const { return quote(print_bytes(*value)); }
  template <typename Number>
  std::string operator()(const std::vector<Number>* values) const {
    std::string text;
    for (const Number value : *values) text += (text.empty() ? "" : ", ") + (*this)(&value);
    return "[" + text + "]";
  }
  std::string operator()(const NamedValue& value) const { return quote(value.names[*value.value]); }
};

}  // namespace

[[noreturn]] void refuse(const Parameter& parameter, std::string_view given) {
  std::ostringstream message;
  message << parameter.key << " = " << given << " is not possible; allowed: " << parameter.allowed;
  const bool is_real = std::holds_alternative<double*>(parameter.value) ||
                       std::holds_alternative<std::vector<double>*>(parameter.value);
  if (is_real && !parse_number<double>(given))
    message << ", as a number without a unit, with a decimal point";
  throw UsageError(message.str());
}

bool in_range(const Parameter& parameter, double value) {
  const bool is_size = std::holds_alternative<std::uint64_t*>(parameter.value);
  if (is_size && value == 0) return true;
  return std::isfinite(value) && parameter.min <= value && value <= parameter.max;
}

std::string print_number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string text(buffer, end);
  const bool is_whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return is_whole ? text + ".0" : text;
}

std::string quote(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7f) {
      constexpr char kDigits[] = "0123456789ABCDEF";
      quoted += "\\u00";
      quoted += kDigits[code >> 4];
      quoted += kDigits[code & 15];
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
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
  std::visit(SetFromText{*this, text}, value);
}

std::uint64_t parse_bytes(std::string_view text) {
  const auto fail = [text] {
    throw Error("\"" + std::string(text) +
                "\" is not a size; allowed: a whole number of bytes, or one with " +
                "KiB, MiB, GiB, TiB, KB, MB, GB or TB, such as 512MiB");
  };
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::optional<std::uint64_t> number = parse_number<std::uint64_t>(text.substr(0, digits));
  std::string_view unit_name = text.substr(digits);
  if (unit_name.starts_with(' ')) unit_name.remove_prefix(1);
  const Unit* unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const Unit& known) { return known.name == unit_name; });
  if (!number || (unit == std::end(kUnits) && digits != text.size())) fail();

  const std::uint64_t factor = unit == std::end(kUnits) ? 1 : unit->bytes;
  if (*number > std::numeric_limits<std::uint64_t>::max() / factor) fail();
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
