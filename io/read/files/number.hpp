// SPDX-License-Identifier: Apache-2.0
// Numbers as text and as bytes, read and written.
#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>

namespace lacuna::io {

// Returns the value that std::from_chars leaves open: infinite if a number is too large for the type, 0 or
// denormal if it is too small.
float parse_extreme(std::string_view text, float);
double parse_extreme(std::string_view text, double);

// Returns false unless all of `text` is one number that fits the type. The number is rounded once, to the
// type of `value`. "nan" and "inf" are floating point numbers; a leading + is allowed.
template <class T>
bool parse_number(std::string_view text, T& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (stop != end || text.empty()) return false;
  if constexpr (std::is_floating_point_v<T>) {
    if (status == std::errc::result_out_of_range) value = parse_extreme(text, T{});
    return status != std::errc::invalid_argument;
  }
  return status == std::errc{};
}

// Reads numbers as other languages write them, too: a decimal comma, an exponent of Fortran ("1.0D+02"), and
// Microsoft's NaN and infinity ("-1.#IND", "1.#QNAN", "1.#INF").
bool parse_foreign_number(std::string_view text, double& value);

// Adds the shortest digits that read back as the same number, such as "0.1" or "1e-07". A number that is not
// finite becomes "nan", "inf" or "-inf".
template <std::floating_point T>
void append_shortest(std::string& text, T value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

// Returns the number that reads as so many digits of the value. Arithmetic would round 0.1 + 0.2 to
// 0.30000000000000004. A number that is not finite stays as it is.
double reread(double value, std::chars_format format, int digits);

// Returns x y z with ten digits.
std::string print_point(const Eigen::Vector3d& point);

// Returns the decimals of places, down to a thousandth of the distance of neighbours; 17 where it is 0.
int place_decimals(double distance);

// Names what `parse_number<T>` takes, for error messages.
std::string describe_whole_number(std::int64_t least, std::uint64_t most);
template <class T>
std::string describe_number() {
  if constexpr (std::is_floating_point_v<T>) {
    return "a number";
  } else {
    return describe_whole_number(std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
  }
}

// Takes the next field off `rest`. With the separator ' ', any run of blanks divides fields. Any other
// character divides fields itself: blanks around it are not part of the field, and no field follows a last
// separator. Returns false if no field is left.
inline bool next_field(std::string_view& rest, char separator, std::string_view& field) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; };
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  if (begin == rest.size()) return false;
  std::size_t end = begin;
  if (separator == ' ') {
    while (end < rest.size() && !is_blank(rest[end])) ++end;
    field = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return true;
  }
  while (end < rest.size() && rest[end] != separator) ++end;
  field = rest.substr(begin, end - begin);
  rest.remove_prefix(end < rest.size() ? end + 1 : end);
  while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
  return true;
}

// Values at any byte of a record, in the byte order of LAS files.

static_assert(std::endian::native == std::endian::little, "LAS records are copied as they are in memory");

template <class T>
requires std::is_trivially_copyable_v<T> T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
requires std::is_trivially_copyable_v<T>
void store(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

// Stores a value, and moves `to` behind it.
template <class T>
void store_next(std::byte*& to, T value) {
  store(to, value);
  to += sizeof value;
}

}  // namespace lacuna::io
