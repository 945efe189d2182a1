#include "io/output_file.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
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

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)), partial_(file_) {
  partial_ += ".partial";
  if (std::error_code error; std::filesystem::is_directory(file_, error)) {
    throw Error(file_.string() + ": is a folder; the result cannot take its place");
  }
  descriptor_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created");
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(partial_.c_str());
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
