// The one exception that ends a job: bad input, a full disk, an impossible setting. Caught once, in main.
#pragma once

#include <stdexcept>

namespace lacuna {

// what() is one line for the user: file, place, reason, what is allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lacuna
