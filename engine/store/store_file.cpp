// SPDX-License-Identifier: Apache-2.0
#include "engine/store/store_file.hpp"

#include "engine/run/error.hpp"

#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& problem) {
  throw Error(path.string() + ": " + problem);
}

[[noreturn]] void fail_with(int error, const std::filesystem::path& path, const std::string& action) {
  fail(path, "cannot " + action + ": " + std::strerror(error));
}

std::string at_byte(std::uint64_t offset) {
  return " at byte " + std::to_string(offset);
}

}  // namespace

std::string random_digits() {
  std::random_device random;
  std::array<char, 17> name{};
  std::snprintf(name.data(), name.size(), "%08x%08x", random(), random());
  return name.data();
}

StoreFile::StoreFile(std::filesystem::path path, Name name)
    : path_(std::move(path)), has_own_name_(name == Name::kKept) {
  static std::mutex one_at_a_time;  // several threads may use the same name
  const std::lock_guard lock(one_at_a_time);
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor_ < 0) fail_with(errno, path_, "create");
  if (name == Name::kRemoved) ::unlink(path_.c_str());
}

std::optional<StoreFile> StoreFile::open_sealed(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error))) return std::nullopt;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
  if (descriptor < 0) fail_with(errno, path, "open");
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    const int reason = errno;
    ::close(descriptor);
    fail_with(reason, path, "read the length");
  }
  return StoreFile(path, descriptor, static_cast<std::uint64_t>(status.st_size));
}

StoreFile::StoreFile(StoreFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      has_own_name_(std::exchange(other.has_own_name_, false)),
      size_(other.size_.load()),
      appended_(other.appended_.load()) {}

StoreFile::~StoreFile() {
  if (has_own_name_) ::unlink(path_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

// This check comes before each write, too: a write beyond the new end would turn what was cut off into zeros.
void StoreFile::check_length() const {
  const std::uint64_t written = size_;
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail_with(errno, path_, "read the length");
  const auto length = static_cast<std::uint64_t>(status.st_size);
  if (length < written)
    fail(path_, "the file was cut short during the run: " + std::to_string(length) + " of " +
                    std::to_string(written) + " bytes are left");
}

void StoreFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  check_length();
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_with(errno, path_, "write" + at_byte(offset));
    if (written == 0) fail(path_, "cannot write" + at_byte(offset) + ": the system takes no more bytes");
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  for (std::uint64_t size = size_; size < offset && !size_.compare_exchange_weak(size, offset);) continue;
}

std::uint64_t StoreFile::append(std::span<const std::byte> bytes) {
  const std::uint64_t offset = appended_.fetch_add(bytes.size());
  write(offset, bytes);
  return offset;
}

void StoreFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  assert(bytes.empty() || offset + bytes.size() <= size_);
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_with(errno, path_, "read" + at_byte(offset));
    if (got == 0) {
      check_length();
      fail(path_, "nothing was written" + at_byte(offset));
    }
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

void StoreFile::start_sync() const {
  ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);  // some file systems cannot
}

void StoreFile::seal(const std::filesystem::path& path) {
  check_length();
  if (::fsync(descriptor_) != 0) fail_with(errno, path_, "bring to the disk");
  if (::rename(path_.c_str(), path.c_str()) != 0)
    fail_with(errno, path_, "rename to " + path.filename().string());
  has_own_name_ = false;
  path_ = path;
  const int folder = ::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);  // some file systems cannot
  ::close(folder);
}

std::byte* StoreFile::map(std::size_t bytes) const {
  // posix_fallocate rather than a sparse file: a full disk is an error here, not a SIGBUS later.
  int error;
  do error = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes));
  while (error == EINTR);
  if (error != 0) fail_with(error, path_, "reserve " + std::to_string(bytes) + " bytes");
  void* const address = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (address == MAP_FAILED) fail_with(errno, path_, "map " + std::to_string(bytes) + " bytes");
  return static_cast<std::byte*>(address);
}

}  // namespace lacuna
