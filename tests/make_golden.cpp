// SPDX-License-Identifier: Apache-2.0
// Writes the golden results in tests/data anew. See tests/support/made_golden.hpp.
#include "tests/support/made_golden.hpp"

#include <cstdio>
#include <exception>

int main() {
  try {
    lacuna::make_golden();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_golden: %s\n", error.what());
    return 1;
  }
}
