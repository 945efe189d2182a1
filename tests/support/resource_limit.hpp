// SPDX-License-Identifier: Apache-2.0
// Limits of the system, for one process.
#pragma once

#include "tests/support/test.hpp"

#include <sys/resource.h>

namespace lacuna::test {

// As long as it lives, this process has at most so much of a resource.
class ResourceLimit {
 public:
  ResourceLimit(__rlimit_resource resource, rlim_t most) : resource_(resource) {
    getrlimit(resource_, &before_);
    const rlimit limit{.rlim_cur = most, .rlim_max = before_.rlim_max};
    if (setrlimit(resource_, &limit) != 0) throw std::runtime_error("cannot limit a resource");
  }
  ~ResourceLimit() { setrlimit(resource_, &before_); }
  ResourceLimit(const ResourceLimit&) = delete;
  ResourceLimit& operator=(const ResourceLimit&) = delete;

 private:
  __rlimit_resource resource_;
  rlimit before_{};
};

// As long as it lives, no file of this process grows beyond so many bytes: writing fails with EFBIG.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes)
      : handler_(std::signal(SIGXFSZ, SIG_IGN)), limit_(RLIMIT_FSIZE, bytes) {}
  ~FileSizeLimit() { std::signal(SIGXFSZ, handler_); }

 private:
  void (*handler_)(int);
  ResourceLimit limit_;
};

}  // namespace lacuna::test
