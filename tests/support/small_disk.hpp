// SPDX-License-Identifier: Apache-2.0
// A disk that is soon full.
#pragma once

#include "tests/support/test.hpp"

#include <sys/mount.h>

namespace lacuna::test {

// A disk of a few hundred KiB. Not there where the tests may not mount one.
class SmallDisk {
 public:
  SmallDisk(fs::path at, const std::string& size) : at_(std::move(at)) {
    fs::create_directory(at_);
    mounted_ = ::mount("tmpfs", at_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount(at_.c_str());
    fs::remove(at_);
  }
  bool mounted() const { return mounted_; }
  const fs::path& path() const { return at_; }

 private:
  fs::path at_;
  bool mounted_;
};

}  // namespace lacuna::test
