// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/input_file.hpp"

#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/run/words.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::io {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// Reads up to `count` bytes, fewer only at the end of the file.
std::size_t read_fully(const InputFile& in, int descriptor, char* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(descriptor, to + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) in.fail(std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace

InputFile::InputFile(std::filesystem::path file, std::size_t buffer_bytes)
    : file_(std::move(file)), buffer_bytes_(buffer_bytes) {
  check_regular_file(file_, "a scan file");
  descriptor_ = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
    fail(std::string("cannot be opened: ") + std::strerror(errno));
  size_ = static_cast<std::uint64_t>(status.st_size);
  buffer_ = std::make_unique_for_overwrite<char[]>(buffer_bytes);
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::uint64_t InputFile::remaining() const {
  return size_ > position() ? size_ - position() : 0;
}

bool InputFile::fill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t got = read_fully(*this, descriptor_, buffer_.get() + end_, buffer_bytes_ - end_);
  end_ += got;
  end_position_ += got;
  return got > 0;
}

std::string_view InputFile::peek(std::size_t count) {
  if (end_ - begin_ < count) fill();
  return {buffer_.get() + begin_, std::min(count, end_ - begin_)};
}

void InputFile::read(std::byte* to, std::size_t count) {
  if (count == 0) return;  // `to` may be null
  const std::size_t buffered = std::min(count, end_ - begin_);
  std::memcpy(to, buffer_.get() + begin_, buffered);
  begin_ += buffered;
  std::size_t missing = count - buffered;
  if (missing == 0) return;
  if (missing < buffer_bytes_ / 4) {
    fill();
    if (end_ >= missing) return read(to + buffered, missing);
    begin_ = end_;
  } else {
    const std::size_t got = read_fully(*this, descriptor_, reinterpret_cast<char*>(to) + buffered, missing);
    end_position_ += got;
    missing -= got;
    if (missing == 0) return;
  }
  fail_at_byte(position(), "the file ends here, in the middle of a row; it must be complete");
}

void InputFile::read_at(std::uint64_t place, std::span<std::byte> to) const {
  while (!to.empty()) {
    const ssize_t got = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) fail_at_byte(place, "the file ends here, too early; it must be complete");
    to = to.subspan(static_cast<std::size_t>(got));
    place += static_cast<std::uint64_t>(got);
  }
}

void InputFile::skip(std::uint64_t count) {
  if (count <= end_ - begin_) {
    begin_ += count;
    return;
  }
  if (count > remaining()) {
    fail_at_byte(size_, "the file ends here, but " + std::to_string(count - remaining()) +
                            " more bytes should follow; it must be complete");
  }
  const std::uint64_t target = position() + count;
  if (::lseek(descriptor_, static_cast<off_t>(target), SEEK_SET) < 0) {
    fail(std::string("cannot be read: ") + std::strerror(errno));
  }
  begin_ = end_ = 0;
  end_position_ = target;
}

void InputFile::accept_lone_returns() {
  constexpr std::size_t kLongestFirstLine = 4096;
  const std::string_view start = peek(kLongestFirstLine);
  const std::size_t end = start.find_first_of("\r\n");
  if (end != std::string_view::npos && start[end] == '\r' && !start.substr(end + 1).starts_with('\n'))
    line_end_ = '\r';
}

std::optional<std::string_view> InputFile::next_line() {
  std::size_t searched = 0;
  for (;;) {
    const char* start = buffer_.get() + begin_;
    const std::size_t have = end_ - begin_;
    const void* found = std::memchr(start + searched, line_end_, have - searched);
    if (found == nullptr) {
      searched = have;
      if (have == buffer_bytes_) {
        fail_at_line(line_ + 1, "longer than the " + std::to_string(buffer_bytes_) + " bytes allowed");
      }
      if (fill()) continue;
      if (have == 0) return std::nullopt;
    }
    const std::size_t length = found ? static_cast<const char*>(found) - start : have;
    std::string_view line(buffer_.get() + begin_, length);
    begin_ += length + (found ? 1 : 0);
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
}

void InputFile::pass_blanks() {
  do {
    while (begin_ < end_ && buffer_[begin_] != line_end_ && is_blank(buffer_[begin_])) ++begin_;
  } while (begin_ == end_ && fill());
}

bool InputFile::next_row() {
  for (;;) {
    pass_blanks();
    if (begin_ == end_) return false;
    if (buffer_[begin_] != line_end_) return true;
    ++begin_;
    ++line_;
  }
}

std::optional<std::string_view> InputFile::next_word() {
  pass_blanks();
  std::size_t length = 0;
  for (;;) {
    const char* start = buffer_.get() + begin_;
    const std::size_t have = end_ - begin_;
    while (length < have && !is_blank(start[length]) && start[length] != line_end_) ++length;
    if (length < have || have == buffer_bytes_ || !fill()) break;
  }
  if (length == 0) return std::nullopt;
  if (length == buffer_bytes_) fail_at_line(line_ + 1, "a value without an end");
  begin_ += length;
  return std::string_view(buffer_.get() + begin_ - length, length);
}

bool InputFile::end_row() {
  pass_blanks();
  if (begin_ < end_ && buffer_[begin_] != line_end_) return false;
  if (begin_ < end_) ++begin_;
  ++line_;
  return true;
}

void InputFile::fail(const std::string& reason) const {
  throw Error(file_.string() + ": " + reason);
}

void InputFile::fail_at_line(std::uint64_t line, const std::string& reason) const {
  fail("line " + std::to_string(line) + ": " + reason);
}

void InputFile::fail_at_byte(std::uint64_t byte, const std::string& reason) const {
  fail("byte " + std::to_string(byte) + ": " + reason);
}

void require_end(InputFile& in, std::string_view padding) {
  constexpr std::size_t kBlock = 4096;
  while (in.remaining() > 0) {
    const std::uint64_t place = in.position();
    const std::string_view block = in.peek(kBlock);
    const std::size_t data = block.find_first_not_of(padding);
    if (data != std::string_view::npos) {
      in.fail_at_byte(place + data,
                      "more data after the last row that the header declares; its counts must hold");
    }
    if (block.empty()) return;
    in.skip(block.size());
  }
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  while (!text.empty() && result.size() <= kLongest) {
    const std::size_t length = utf8_length(text);
    const bool is_printable = length > 0 && !is_control(text.substr(0, length));
    result += is_printable ? text.substr(0, length) : "?";
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result + (text.empty() ? "'" : "...'");
}

namespace {

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

// Returns nothing if the system cannot give the file's state; errno says why.
std::optional<FileState> look_up(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileState{.device = status.st_dev,
                   .inode = status.st_ino,
                   .size = static_cast<std::uint64_t>(status.st_size),
                   .mtime = nanoseconds(status.st_mtim),
                   .ctime = nanoseconds(status.st_ctim)};
}

// Returns an empty text if nothing differs.
std::string difference(const FileState& before, const std::optional<FileState>& now) {
  if (!now) return std::string("it cannot be found any more: ") + std::strerror(errno);
  if (now->device != before.device || now->inode != before.inode) return "another file has taken its place";
  if (now->size != before.size) {
    return "it had " + std::to_string(before.size) + " bytes and has " + std::to_string(now->size) + " now";
  }
  if (now->mtime != before.mtime) return "it was written to";
  return now->ctime != before.ctime ? "its content, names, owner or permissions were changed" : "";
}

}  // namespace

std::optional<FileIdentity> find_identity(const std::filesystem::path& file) {
  const std::optional<FileState> state = look_up(file);
  return state ? std::optional(FileIdentity(state->device, state->inode)) : std::nullopt;
}

FileState file_state(const std::filesystem::path& file) {
  const auto state = look_up(file);
  if (!state) check_regular_file(file, "a scan file");  // says of an address that it is one
  if (!state) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  return *state;
}

Digest sample_digest(const std::filesystem::path& file, const FileState& state) {
  constexpr std::uint64_t kBlocks = 16, kBlock = 64 << 10;
  std::ifstream in(file, std::ios::binary);
  std::vector<char> sample;
  for (std::uint64_t i = 0; i < kBlocks; ++i) {
    const std::uint64_t last = state.size - std::min(state.size, kBlock);
    const std::size_t before = sample.size();
    sample.resize(before + std::min(state.size, kBlock));
    in.seekg(static_cast<std::streamoff>(last / (kBlocks - 1) * i));
    in.read(&sample[before], static_cast<std::streamsize>(sample.size() - before));
  }
  if (!in) throw Error(file.string() + ": cannot be read: " + std::strerror(errno));
  return digest_of(std::as_bytes(std::span(sample)));
}

void check_unchanged(const std::filesystem::path& file, const FileState& before) {
  const std::string different = difference(before, look_up(file));
  if (different.empty()) return;
  throw Error(file.string() + ": has changed during the run (" + different +
              "); an input must stay as it is until the run ends");
}

}  // namespace lacuna::io
