// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/arithmetic_coder.hpp"

#include <utility>

namespace lacuna::io::laz {

std::vector<std::byte> read_all(const ChunkBytes& bytes, std::uint64_t begin, std::uint64_t end) {
  if (end > bytes.size()) throw Corrupt("a chunk of compressed points is cut");
  std::vector<std::byte> all, buffer;
  all.reserve(end - begin);
  while (begin < end) {
    const std::span<const std::byte> piece = bytes.read(begin, end, buffer);
    all.insert(all.end(), piece.begin(), piece.end());
    begin += piece.size();
  }
  return all;
}

void ArithmeticDecoder::read_more() {
  if (left_at_ == left_end_) throw Corrupt("the compressed points end too early");
  const std::span<const std::byte> piece = bytes_->read(left_at_, left_end_, buffer_);
  next_ = piece.data();
  end_ = next_ + piece.size();
  left_at_ += piece.size();
}

// Adds one to the number that the bytes are. It does not grow longer, since the interval stays within 0 to 1.
void ArithmeticEncoder::carry() {
  auto byte = bytes_.rbegin();
  for (; *byte == std::byte{0xff}; ++byte) *byte = std::byte{0};
  *byte = static_cast<std::byte>(std::to_integer<unsigned>(*byte) + 1);
}

std::vector<std::byte> ArithmeticEncoder::finish() {
  // Few bytes that stand for a place in the interval, and zeros, so that a decoder may read ahead.
  const bool is_long = length_ > 2 * kMinLength;
  if (is_long) {
    narrow(kMinLength, kMinLength / 2);
  } else {
    narrow(kMinLength / 2, kMinLength / 512);
  }
  bytes_.insert(bytes_.end(), is_long ? 3 : 2, std::byte{0});
  return std::move(bytes_);
}

}  // namespace lacuna::io::laz
