#include "io/output_file.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

void remove_stale(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error)
    throw Error(file.string() + ": the result of an earlier run cannot be removed: " + error.message());
}

}  // namespace

std::filesystem::path partial_path(std::filesystem::path file) {
  return file += ".partial";
}

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)), partial_(partial_path(file_)) {
  if (std::error_code error; std::filesystem::is_directory(file_, error)) {
    throw Error(file_.string() + ": is a folder; the result cannot take its place");
  }
  open_alone();
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(partial_.c_str());
  ::close(lock_);
}

void OutputFile::open_alone() {
  constexpr int kAttempts = 100;  // runs that begin and end at just that time
  for (int attempt = 1;; ++attempt) {
    lock_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) fail("cannot be created");
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(lock_);
      throw Error(file_.string() + ": another run is writing it");
    }
    // Before it was locked, the run that wrote it may have put it in place or removed it.
    struct stat opened {};
    struct stat named {};
    const bool is_it = ::fstat(lock_, &opened) == 0 && ::stat(partial_.c_str(), &named) == 0 &&
                       opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
    if (is_it && (!S_ISREG(opened.st_mode) || ::ftruncate(lock_, 0) == 0)) break;
    ::close(lock_);
    if (is_it || attempt == kAttempts) fail("cannot be created");
  }
  descriptor_ = ::fcntl(lock_, F_DUPFD_CLOEXEC, 0);
  if (descriptor_ < 0) fail("cannot be created");
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

void OutputFile::overwrite_start(std::string_view text) {
  flush();
  assert(text.size() <= end_);
  put(0, std::as_bytes(std::span(text)));
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
    if (written < 0) fail("cannot be written");
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  flush();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written");
}

void OutputFile::commit() {
  close();
  if (::rename(partial_.c_str(), file_.c_str()) != 0) fail("cannot be put in place");
  committed_ = true;
}

void OutputFile::fail(const char* what) const {
  throw Error(file_.string() + ": " + what + ": " + std::strerror(errno));
}

OutputFile& OutputSet::add(const std::string& name) {
  return *files_.emplace_back(std::make_unique<OutputFile>(folder_ / name));
}

void OutputSet::commit(const std::vector<std::string>& stale) {
  for (const auto& file : files_) file->close();
  for (const auto& name : stale) remove_stale(folder_ / name);
  for (const auto& file : files_) remove_stale(file->path());
  for (const auto& file : files_) file->commit();
}

}  // namespace lacuna
