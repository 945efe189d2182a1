// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/output_file.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace lacuna::io {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

OutputFile::OutputFile(std::filesystem::path name, const std::filesystem::path& place, Writer writer)
    : name_(std::move(name)), place_(place), writer_(writer) {
  if (writer == Writer::kLibrary) return;
  descriptor_ = ::open(place.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created", errno);
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::span<const std::byte> bytes) {
  assert(descriptor_ >= 0);
  while (!bytes.empty()) {
    const auto fitting = bytes.first(std::min(bytes.size(), kBufferBytes - buffer_.size()));
    buffer_.insert(buffer_.end(), fitting.begin(), fitting.end());
    bytes = bytes.subspan(fitting.size());
    if (buffer_.size() == kBufferBytes) flush();
  }
}

void OutputFile::overwrite(std::uint64_t at, std::span<const std::byte> bytes) {
  flush();
  assert(at + bytes.size() <= end_);
  put(at, bytes);
}

void OutputFile::flush() {
  put(end_, buffer_);
  end_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::put(std::uint64_t at, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written", written < 0 ? errno : ENOSPC);
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

bool OutputFile::close() {
  if (writer_ == Writer::kLibrary) {
    descriptor_ = ::open(place_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor_ < 0 && errno == ENOENT) return false;
    if (descriptor_ < 0) fail("cannot be written", errno);
  }
  if (descriptor_ < 0) return true;
  if (writer_ == Writer::kThis) flush();
  if (::fsync(descriptor_) != 0) fail("cannot be written", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written", errno);
  return true;
}

void OutputFile::fail(const char* what, int reason) const {
  throw Error(name_.string() + ": " + what + ": " + std::strerror(reason));
}

}  // namespace lacuna::io
