// SPDX-License-Identifier: Apache-2.0
#include "io/read/e57/paged_file.hpp"

#include "io/read/files/number.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <span>

namespace lacuna::io {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{256} << 10;
constexpr std::size_t kBufferBytes = 4096;  // blocks are larger, and read past it

constexpr std::uint32_t kPolynomial = 0x82f63b78;  // 0x1edc6f41 with its bits reversed
constexpr std::size_t kBytesAtOnce = 8;

using Table = std::array<std::uint32_t, 256>;

// Table k has the checksum of each byte that k bytes of zero follow.
constexpr std::array<Table, kBytesAtOnce> kTables = [] {
  std::array<Table, kBytesAtOnce> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ ((rest & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kBytesAtOnce; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = before >> 8 ^ tables[0][before & 255];
    }
  }
  return tables;
}();

// CRC-32C (polynomial 0x1EDC6F41, reflected, all bits inverted before and after): ASTM E2807-11; RFC 3720,
// 12.1. The result is the same on every machine. Eight bytes at once: Kounavis, Berry, A systematic approach
// to building high performance software-based CRC generators, ISCC 2005.
std::uint32_t page_checksum(std::span<const std::byte> data) {
  std::uint32_t checksum = ~std::uint32_t{0};
  for (; data.size() >= kBytesAtOnce; data = data.subspan(kBytesAtOnce)) {
    const std::uint64_t word = load<std::uint64_t>(data.data()) ^ checksum;
    checksum = 0;
    for (std::size_t i = 0; i < kBytesAtOnce; ++i)
      checksum ^= kTables[kBytesAtOnce - 1 - i][word >> 8 * i & 255];
  }
  for (const std::byte byte : data) {
    checksum = checksum >> 8 ^ kTables[0][(checksum ^ std::to_integer<std::uint32_t>(byte)) & 255];
  }
  return ~checksum;
}

std::uint32_t stored_checksum(const std::byte* from) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < PagedFile::kChecksumBytes; ++i) {
    value = value << 8 | std::to_integer<std::uint32_t>(from[i]);
  }
  return value;
}

}  // namespace

PagedFile::PagedFile(const std::filesystem::path& file, std::size_t page_bytes)
    : in_(std::make_unique<InputFile>(file, kBufferBytes)),
      page_bytes_(page_bytes),
      data_bytes_(page_bytes - kChecksumBytes),
      pages_(in_->remaining() / page_bytes),
      size_(pages_ * data_bytes_) {
  assert(page_bytes > kChecksumBytes);
  if (in_->remaining() % page_bytes != 0) {
    in_->fail_at_byte(pages_ * page_bytes, "the file ends here, within a page of " +
                                               std::to_string(page_bytes) + " bytes; it must be complete");
  }
}

void PagedFile::seek(std::uint64_t physical, const std::string& what) {
  const std::uint64_t page = physical / page_bytes_, offset = physical % page_bytes_;
  if (page >= pages_) {
    in_->fail_at_byte(pages_ * page_bytes_, "the file ends here, but " + what + " should begin at byte " +
                                                std::to_string(physical) + "; it must be complete");
  }
  if (offset >= data_bytes_) {
    in_->fail_at_byte(physical, what + " should begin here, within a checksum; its offset must hold");
  }
  position_ = page * data_bytes_ + offset;
}

void PagedFile::skip(std::uint64_t count) {
  assert(count <= size_ - position_);
  position_ += count;
}

void PagedFile::read(std::byte* to, std::size_t count) {
  if (count > size_ - position_) fail(size_, "the file ends here, too early; it must be complete");
  while (count > 0) {
    const std::byte* const page = checked_page(position_ / data_bytes_);
    const std::size_t offset = position_ % data_bytes_;
    const std::size_t ready = std::min(count, data_bytes_ - offset);
    std::memcpy(to, page + offset, ready);
    position_ += ready;
    to += ready;
    count -= ready;
  }
}

void PagedFile::fail(std::uint64_t logical, const std::string& reason) const {
  fail_physical(logical / data_bytes_ * page_bytes_ + logical % data_bytes_, reason);
}

void PagedFile::fail_physical(std::uint64_t physical, const std::string& reason) const {
  in_->fail_at_byte(physical, reason);
}

const std::byte* PagedFile::checked_page(std::uint64_t page) {
  if (page < block_begin_ || page >= block_end_) load(page);
  const std::byte* const bytes = block_.data() + (page - block_begin_) * page_bytes_;
  if (checked_pages_ == page + 1) return bytes;
  if (page_checksum(std::span(bytes, data_bytes_)) != stored_checksum(bytes + data_bytes_)) {
    in_->fail_at_byte(page * page_bytes_, "the checksum of the page of " + std::to_string(page_bytes_) +
                                              " bytes from here on is wrong; the file is damaged");
  }
  checked_pages_ = page + 1;
  return bytes;
}

void PagedFile::load(std::uint64_t page) {
  const std::uint64_t begin = page * page_bytes_;
  if (begin < in_->position()) in_ = std::make_unique<InputFile>(in_->file(), kBufferBytes);
  in_->skip(begin - in_->position());
  const std::uint64_t count =
      std::min<std::uint64_t>(std::max<std::size_t>(1, kBlockBytes / page_bytes_), pages_ - page);
  block_.resize(count * page_bytes_);
  block_begin_ = block_end_ = page;
  checked_pages_ = 0;
  in_->read(block_.data(), block_.size());
  block_end_ = page + count;
}

}  // namespace lacuna::io
