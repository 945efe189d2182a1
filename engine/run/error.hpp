// The one exception that ends a job: bad input, a full disk, an impossible setting. Caught once, in main.
#pragma once

#include <stdexcept>
#include <string>

namespace lacuna {

// what() is one line for the user: file, place, reason, what is allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What was chosen is not possible: an option, or a value of a config.
class UsageError : public Error {
 public:
  using Error::Error;
};

// The input is read twice; it was not the same. `how`: what shows it.
[[noreturn]] inline void fail_changed(const std::string& how) {
  throw Error("the input changed while it was read: " + how);
}

// What one step reads of another does not agree: a fault of the program or of the machine. `how`: what shows
// it.
[[noreturn]] inline void fail_inconsistent(const std::string& how) {
  throw Error("the run contradicts itself: " + how + "; please report this");
}

}  // namespace lacuna
