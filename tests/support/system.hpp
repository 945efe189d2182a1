// SPDX-License-Identifier: Apache-2.0
// The system around a test: processes, the files that they have open, the heap, limits, and a disk that is
// soon full.
#pragma once

#include "tests/support/test.hpp"

#include <compare>
#include <functional>
#include <string>

#include <malloc.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/types.h>

namespace lacuna::test {

// Does this in a process of its own, which may kill itself.
void do_apart(const std::function<void()>& act);

// Does this in so many processes at once. `wait` returns once all others have failed by an exception. Returns
// how many did not fail.
std::size_t do_at_once(std::size_t processes,
                       const std::function<void(const std::function<void()>& wait)>& act);

// ---- Open files, with or without a name: what happens to a run when one of them changes

// Whether `process` has a file open that was created as `name`, in whatever folder, and that is not empty.
bool has_open(pid_t process, const std::string& name);

// Cuts it to half of its length. False if there is none.
bool cut_open_file(pid_t process, const std::string& name);

// ---- Limits

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

struct Record {
  std::uint64_t key, payload;
  friend auto operator<=>(const Record&, const Record&) = default;
};

// Bytes of the heap in use.
inline std::size_t heap_in_use() {
  return ::mallinfo2().uordblks + ::mallinfo2().hblkhd;
}

}  // namespace lacuna::test
