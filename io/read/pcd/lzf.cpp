// SPDX-License-Identifier: Apache-2.0
#include "io/read/pcd/lzf.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace lacuna::io {
namespace {

constexpr std::size_t kFarthest = 8192;
constexpr std::size_t kLongest = 264;
constexpr std::size_t kBufferBytes = std::size_t{32} << 10;  // unpacked, and as large again for the file
constexpr std::size_t kChunkBytes = 4096;

// The content of one step.
struct Step {
  std::size_t packed;    // its own bytes
  std::size_t length;    // bytes that it writes
  std::size_t distance;  // back to the bytes that it repeats; 0: the step itself has the bytes
};

unsigned byte_at(std::string_view bytes, std::size_t place) {
  return static_cast<unsigned char>(bytes[place]);
}

// `packed` is more than there is in `bytes` if these end within the step.
Step read_step(std::string_view bytes) {
  const unsigned first = byte_at(bytes, 0);
  if (first < 32) return {.packed = first + 2, .length = first + 1, .distance = 0};
  const bool is_long = first >> 5 == 7;
  const std::size_t packed = is_long ? 3 : 2;
  if (bytes.size() < packed) return {.packed = packed, .length = 0, .distance = 0};
  return {.packed = packed,
          .length = (first >> 5) + 2 + (is_long ? byte_at(bytes, 1) : 0),
          .distance = ((first & 31) << 8) + byte_at(bytes, packed - 1) + 1};
}

}  // namespace

LzfStream::LzfStream(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t packed,
                     std::uint64_t unpacked)
    : in_(std::make_unique<InputFile>(file, kBufferBytes)),
      packed_left_(packed),
      unpacked_(unpacked),
      unpacked_left_(unpacked),
      bytes_(kFarthest + kBufferBytes) {
  in_->skip(begin);
}

LzfStream LzfStream::fork() const {
  LzfStream result(in_->file(), in_->position(), packed_left_, unpacked_);
  result.unpacked_left_ = unpacked_left_;
  result.bytes_ = bytes_;
  result.begin_ = begin_;
  result.end_ = end_;
  return result;
}

void LzfStream::read(std::byte* to, std::size_t count) {
  while (count > 0) {
    const std::size_t ready = take(count);
    std::memcpy(to, bytes_.data() + begin_, ready);
    begin_ += ready;
    to += ready;
    count -= ready;
  }
}

void LzfStream::skip(std::uint64_t count) {
  while (count > 0) {
    const std::size_t ready = take(count);
    begin_ += ready;
    count -= ready;
  }
}

void LzfStream::require_end() const {
  if (begin_ == end_ && packed_left_ == 0 && unpacked_left_ == 0) return;
  in_->fail_at_byte(in_->position(), "the compressed block goes on for " + std::to_string(packed_left_) +
                                         " bytes after its " + std::to_string(unpacked_) +
                                         " uncompressed bytes are complete; its sizes must hold");
}

std::size_t LzfStream::take(std::uint64_t count) {
  if (begin_ == end_) unpack();
  return static_cast<std::size_t>(std::min<std::uint64_t>(count, end_ - begin_));
}

void LzfStream::unpack() {
  const std::size_t kept = std::min(end_, kFarthest);
  std::memmove(bytes_.data(), bytes_.data() + end_ - kept, kept);
  begin_ = end_ = kept;
  do {
    unpack_chunk();
  } while (packed_left_ > 0 && unpacked_left_ > 0 && bytes_.size() - end_ >= kLongest);
}

void LzfStream::unpack_chunk() {
  const std::string_view chunk =
      in_->peek(static_cast<std::size_t>(std::min<std::uint64_t>(packed_left_, kChunkBytes)));
  std::size_t used = 0;
  const auto fail = [&](const std::string& reason) { in_->fail_at_byte(in_->position() + used, reason); };
  while (used < chunk.size() && unpacked_left_ > 0 && bytes_.size() - end_ >= kLongest) {
    const Step step = read_step(chunk.substr(used));
    if (step.packed > chunk.size() - used) break;
    if (step.length > unpacked_left_) {
      fail("the compressed block comes to more than its " + std::to_string(unpacked_) +
           " uncompressed bytes; its sizes must hold");
    }
    if (step.distance > end_) {
      fail("a repetition of bytes before the beginning of the compressed block; the file is damaged");
    }
    std::byte* to = bytes_.data() + end_;
    if (step.distance == 0) {
      std::memcpy(to, chunk.data() + used + 1, step.length);
    } else {
      // The bytes repeated may be among those written.
      for (std::size_t i = 0; i < step.length; ++i) to[i] = *(to + i - step.distance);
    }
    end_ += step.length;
    unpacked_left_ -= step.length;
    used += step.packed;
  }
  if (used == 0) {
    fail("the compressed block ends here, " + std::to_string(unpacked_left_) + " of its " +
         std::to_string(unpacked_) + " uncompressed bytes too early; it must be complete");
  }
  in_->skip(used);
  packed_left_ -= used;
}

}  // namespace lacuna::io
