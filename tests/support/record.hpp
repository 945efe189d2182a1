// SPDX-License-Identifier: Apache-2.0
// What tests put into stores: two numbers, ordered by key.
#pragma once

#include "tests/support/test.hpp"

#include <compare>

#include <malloc.h>

namespace lacuna::test {

struct Record {
  std::uint64_t key, payload;
  friend auto operator<=>(const Record&, const Record&) = default;
};

// Bytes of the heap in use.
inline std::size_t heap_in_use() {
  return ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
}

}  // namespace lacuna::test
