// SPDX-License-Identifier: Apache-2.0
#include "io/read/laz/arithmetic_decoder.hpp"

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

}  // namespace lacuna::io::laz
