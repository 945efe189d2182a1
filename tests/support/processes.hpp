// SPDX-License-Identifier: Apache-2.0
// Processes that a test forks.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

// Does this in a process of its own, which may kill itself.
void do_apart(const std::function<void()>& act);

// Does this in so many processes at once. `wait` returns once all others have failed by an exception. Returns
// how many did not fail.
std::size_t do_at_once(std::size_t processes,
                       const std::function<void(const std::function<void()>& wait)>& act);

}  // namespace lacuna::test
