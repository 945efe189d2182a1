// What to say of a key or section of a config file that does not exist.
#pragma once

#include "engine/config.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// Null: there is none of that name.
const Parameter* find_key(const std::vector<Parameter>& all, std::string_view key);

bool is_section(const std::vector<Parameter>& all, std::string_view name);

// The error, with what is allowed and with the key that may be meant.
std::string unknown_key(const std::vector<Parameter>& all, std::string_view section, std::string_view key);

// Likewise. `is_table`: false for a key outside of all sections.
std::string unknown_section(const std::vector<Parameter>& all, std::string_view name, bool is_table);

}  // namespace lacuna
