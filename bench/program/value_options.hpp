// SPDX-License-Identifier: Apache-2.0
// Options whose values are checked before they are used: an error says what is allowed.
#pragma once

#include "io/files/number.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace lacuna::tools {

// A value by its name.
template <class T>
struct Choice {
  const char* name;
  T value;
};

// An option that takes one of the names. Its type name has them all, "a|b": help and completions take them
// from there.
template <class T, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option, const std::array<Choice<T>, N>& choices,
                        T& value, const std::string& help) {
  std::string names, type_name;
  for (const Choice<T>& choice : choices) {
    names += (names.empty() ? "" : ", ") + std::string(choice.name);
    type_name += (type_name.empty() ? "" : "|") + std::string(choice.name);
  }
  const auto choose = [&choices, &value, option, names](const std::string& text) {
    for (const Choice<T>& choice : choices) {
      if (text != choice.name) continue;
      value = choice.value;
      return;
    }
    throw CLI::ValidationError(option + " = " + text, "is not possible; allowed: " + names);
  };
  return command.add_option_function<std::string>(option, choose, help)->type_name(type_name);
}

// For options that take whole numbers: CLI11 alone makes a number near 2^64 of -1.
inline CLI::Validator whole_number() {
  const auto check = [](const std::string& text) {
    const bool is_whole = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    return is_whole ? std::string() : text + " is not possible; allowed: a whole number, 0 or more";
  };
  return CLI::Validator(check, "");
}

// For files that are written in one format: another ending would be taken for another format. Upper case is
// allowed.
inline CLI::Validator name_ending_in(const std::string& ending) {
  const auto check = [ending](const std::string& text) {
    const std::string own = CLI::detail::to_lower(std::filesystem::path(text).extension().string());
    return own == ending ? std::string() : text + " is not possible; allowed: a name that ends in " + ending;
  };
  return CLI::Validator(check, "");
}

// For options that take real numbers.
inline CLI::Validator real_number() {
  const auto check = [](const std::string& text) {
    double value = 0;
    return io::parse_number(text, value)
               ? std::string()
               : text + " is not possible; allowed: a number without a unit, with a decimal point";
  };
  return CLI::Validator(check, "");
}

}  // namespace lacuna::tools
