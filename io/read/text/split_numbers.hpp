// SPDX-License-Identifier: Apache-2.0
// Rows whose values may be parts of numbers, because one sign has two meanings.
#pragma once

#include "io/read/text/text_start.hpp"

#include <span>
#include <string>

namespace lacuna::io {

// Says why values of rows without names may be parts of numbers; empty: nothing speaks for it. Commas may
// divide values and begin decimals, as in "500000,053,5400000,363". Blanks may divide values and thousands,
// as in "500 000.25 5 400 000.36". Leading zeros, or the same form of two numbers in every row, say so.
std::string doubt_of_split_numbers(std::span<const Line> rows, char separator);

}  // namespace lacuna::io
