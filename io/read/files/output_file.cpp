// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/output_file.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
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

namespace {

namespace fs = std::filesystem;

// Returns the kind of the file that has the name, of a link itself; nothing if no file has it.
std::optional<mode_t> find(const fs::path& name) {
  struct stat found {};
  if (::lstat(name.c_str(), &found) == 0) return found.st_mode;
  if (errno != ENOENT && errno != ENOTDIR)
    throw Error(name.string() + ": cannot be examined: " + std::strerror(errno));
  return std::nullopt;
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

bool has_mark(const fs::path& file, const FileMark& mark) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  std::string begin(mark.text.size(), '\0');
  const ssize_t length = ::pread(descriptor, begin.data(), begin.size(), static_cast<off_t>(mark.offset));
  ::close(descriptor);
  return length == static_cast<ssize_t>(begin.size()) && begin == mark.text;
}

}  // namespace

void check_output(const fs::path& file, const FileMark& mark, Overwrite overwrite) {
  if (!file.has_filename()) throw Error("\"" + file.string() + "\": a file name is needed");
  const std::optional<mode_t> found = find(file);
  if (!found) return;
  if (!S_ISREG(*found))
    throw Error(file.string() + ": is " + kind_of(*found) +
                "; only regular files are replaced: remove it, or choose another place");
  if (overwrite == Overwrite::kOwn && !has_mark(file, mark))
    throw Error(
        file.string() +
        ": exists, and this command did not write it; choose another place, or replace it with --overwrite");
}

NewFile::NewFile(const fs::path& file, const FileMark& mark, Overwrite overwrite)
    : file_((check_output(file, mark, overwrite), file)),
      mark_(mark),
      overwrite_(overwrite),
      folder_(file.has_parent_path() ? file.parent_path() : ".", kTemporaryPrefix),
      content_(file, folder_.path() / "new") {
  remove_leftovers(folder_.path().parent_path(), kTemporaryPrefix);
}

void NewFile::commit() {
  content_.close();
  const RemovalPause pause;
  check_output(file_, mark_, overwrite_);
  if (::rename(content_.place().c_str(), file_.c_str()) != 0)
    throw Error(file_.string() + ": cannot be put in place: " + std::strerror(errno));
}

}  // namespace lacuna::io
