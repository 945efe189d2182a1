// SPDX-License-Identifier: Apache-2.0
// The one exception that ends a run: bad input, a full disk, an impossible setting. Caught once, in main.
#pragma once

#include "engine/export.hpp"

#include <stdexcept>
#include <string>

namespace lacuna {

// what() is one line for the user: file, place, reason, what is allowed.
class LACUNA_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The user has chosen an option, or a value of a config, that is not possible.
class LACUNA_API UsageError : public Error {
 public:
  using Error::Error;
};

// Fails because the input is read twice and was not the same. `how`: what shows it.
[[noreturn]] inline void fail_changed(const std::string& how) {
  throw Error("the input changed while it was read: " + how);
}

// Fails because the data of two steps do not agree. That is a fault of the program or of the machine. `how`
// says what shows the fault.
[[noreturn]] inline void fail_inconsistent(const std::string& how) {
  throw Error("the run contradicts itself: " + how + "; please report this");
}

}  // namespace lacuna
