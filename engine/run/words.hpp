// SPDX-License-Identifier: Apache-2.0
// Lists of words in messages: what is allowed, and what may have been meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// Returns a list such as "k, eps, eps_fraction".
std::string listed(const std::vector<std::string_view>& words);

// Returns " (did you mean "k"?)" where one of the words is close to this one, else an empty string.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words);

}  // namespace lacuna
