// What to say of a word that does not exist: a key or section of a config file, an option, a command.
#pragma once

#include "engine/config.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// " (did you mean "k"?)" where one of the words is close to this one, else nothing.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words);

// Null: there is none of that name.
const Parameter* find_key(const std::vector<Parameter>& all, std::string_view key);

bool is_section(const std::vector<Parameter>& all, std::string_view name);

// The error, with what is allowed and with the key that may be meant.
std::string unknown_key(const std::vector<Parameter>& all, std::string_view section, std::string_view key);

// Returns the message for an unknown section. `is_table`: false for a key outside of all sections.
std::string unknown_section(const std::vector<Parameter>& all, std::string_view name, bool is_table);

}  // namespace lacuna
