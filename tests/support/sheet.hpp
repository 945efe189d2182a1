// SPDX-License-Identifier: Apache-2.0
// A small scan as text.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

// A flat, uneven sheet of n by n points with a square hole in its middle.
inline std::string sheet(int n) {
  std::ostringstream out;
  out << "x y z\n";
  const int from = n / 2 - n / 8;
  const int to = n / 2 + n / 8;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const bool in_hole = from <= i && i < to && from <= j && j < to;
      if (!in_hole) out << i + 0.1 * ((i * 7 + j * 3) % 5) << ' ' << j + 0.1 * ((i + j * 5) % 7) << " 0\n";
    }
  }
  return out.str();
}

}  // namespace lacuna::test
