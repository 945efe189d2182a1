// SPDX-License-Identifier: Apache-2.0
// Numbers as text that reads back as the same number.
#pragma once

#include <string>

namespace lacuna::io {

// The shortest digits, such as "0.1" or "1e-07". What is not finite is "nan", "inf" or "-inf".
void append_shortest(std::string& text, double value);

// The shortest digits without an exponent, such as "500000.125". Below 1e-15 and from 1e15 on as above. For
// formats whose readers may not know exponents.
void append_plain(std::string& text, double value);

}  // namespace lacuna::io
