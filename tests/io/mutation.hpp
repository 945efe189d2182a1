// SPDX-License-Identifier: Apache-2.0
// Files changed at random, the same for the same seed.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

// Returns `whole` with one to four random changes. Bytes are set, bits flipped, spans removed, repeated,
// inserted or swapped. Integers become extreme values, numbers of text change, or the end is cut off. Each
// `number` gives a file of its own, on every machine the same.
std::string mutated(const std::string& whole, std::uint32_t seed, std::uint32_t number);

}  // namespace lacuna::test
