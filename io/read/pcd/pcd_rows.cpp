// SPDX-License-Identifier: Apache-2.0
#include "io/read/pcd/pcd_rows.hpp"

#include "io/read/files/line_words.hpp"
#include "io/read/files/little_endian.hpp"
#include "io/read/pcd/pcd_fields.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostHeldColumns = 256;  // of a compressed file: each takes a stream

std::uint32_t read_size(InputFile& in) {
  std::array<std::byte, 4> bytes;
  in.read(bytes.data(), bytes.size());
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= std::to_integer<std::uint32_t>(bytes[i]) << 8 * i;
  return size;
}

bool is_product(std::uint64_t product, std::uint64_t a, std::uint64_t b) {
  return b == 0 ? product == 0 : product % b == 0 && product / b == a;
}

}  // namespace

PcdRows::PcdRows(const std::filesystem::path& file)
    : in_(file), header_(read_pcd_header(in_)), left_(header_.rows), row_bytes_(header_.row_bytes()) {
  if (header_.encoding == PcdEncoding::kCompressed) {
    if (header_.rows > 0) open_block();
  } else {
    require_size();
  }
}

std::size_t PcdRows::next(std::vector<std::byte>& rows, std::size_t max_rows) {
  assert(max_rows > 0);
  const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / row_bytes_);
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::min(max_rows, fitting)));
  if (count == 0) {
    require_end(in_, padding());
    return 0;
  }
  rows.resize(count * row_bytes_);
  if (header_.encoding == PcdEncoding::kAscii) {
    for (std::size_t row = 0; row < count; ++row) read_text_row(rows.data() + row * row_bytes_);
  } else if (header_.encoding == PcdEncoding::kBinary) {
    in_.read(rows.data(), rows.size());
  } else {
    read_columns(rows.data(), count);
  }
  left_ -= count;
  return count;
}

// PCL reserves more than the rows or the compressed block need, up to a page, and leaves the rest zero.
std::string_view PcdRows::padding() const {
  using std::string_view_literals::operator""sv;
  if (header_.encoding == PcdEncoding::kAscii) return kBlanks;
  return header_.encoding == PcdEncoding::kBinary ? "\0 \t\r\n\v\f"sv : "\0"sv;
}

// The rows of an uncompressed file.
void PcdRows::require_size() const {
  const bool is_text = header_.encoding == PcdEncoding::kAscii;
  std::uint64_t least = row_bytes_, left = in_.remaining();
  if (is_text) {
    // A character and a blank for each value, but the last line may have no end.
    least = 0;
    for (const PcdField& field : header_.fields) least += 2 * field.count;
    ++left;
  }
  if (header_.rows > left / least) fail_too_short();
}

void PcdRows::fail_too_short() const {
  in_.fail_at_byte(in_.position() + in_.remaining(), "the file ends here, too early for the " +
                                                         std::to_string(header_.rows) +
                                                         " points of its header; it must be complete");
}

// A compressed file: two sizes, then the block.
void PcdRows::open_block() {
  const std::uint64_t place = in_.position();
  if (in_.remaining() < 8) fail_too_short();
  block_bytes_ = read_size(in_);
  unpacked_bytes_ = read_size(in_);
  if (block_bytes_ > in_.remaining()) fail_too_short();
  // PCL leaves padding out of the block; other writers may not.
  const std::uint64_t with_padding = row_bytes_;
  const std::uint64_t without = row_bytes_ - header_.padding_bytes();
  has_padding_ = is_product(unpacked_bytes_, header_.rows, with_padding);
  if (!has_padding_ && !is_product(unpacked_bytes_, header_.rows, without)) {
    in_.fail_at_byte(place + 4, std::to_string(unpacked_bytes_) + " uncompressed bytes are not " +
                                    std::to_string(header_.rows) + " points of " + std::to_string(without) +
                                    " bytes; they must be equal");
  }
  if (unpacked_bytes_ > block_bytes_ * kLzfLargestRatio) {
    in_.fail_at_byte(place, std::to_string(block_bytes_) + " compressed bytes cannot come to the " +
                                std::to_string(unpacked_bytes_) + " declared; at most " +
                                std::to_string(kLzfLargestRatio) + " times as many are possible");
  }
  const auto columns = std::count_if(header_.fields.begin(), header_.fields.end(),
                                     [](const PcdField& field) { return !field.is_padding(); });
  if (static_cast<std::size_t>(columns) > kMostHeldColumns) {
    in_.fail_at_byte(place, std::to_string(columns) + " fields; compressed files may have " +
                                std::to_string(kMostHeldColumns));
  }
}

// Unpacks the whole block once, to find where each column begins.
void PcdRows::start_columns() {
  LzfStream stream(in_.file(), in_.position(), block_bytes_, unpacked_bytes_);
  for (const PcdField& field : header_.fields) {
    if (field.is_padding() && !has_padding_) continue;
    if (!field.is_padding()) columns_.push_back(stream.fork());
    stream.skip(header_.rows * field.bytes());
  }
  stream.require_end();
  in_.skip(block_bytes_);
}

void PcdRows::read_columns(std::byte* rows, std::size_t count) {
  if (columns_.empty()) start_columns();
  std::size_t offset = 0, column = 0;
  for (const PcdField& field : header_.fields) {
    if (!field.is_padding()) {
      column_bytes_.resize(count * field.bytes());
      columns_[column++].read(column_bytes_.data(), column_bytes_.size());
      for (std::size_t row = 0; row < count; ++row) {
        std::memcpy(rows + row * row_bytes_ + offset, column_bytes_.data() + row * field.bytes(),
                    field.bytes());
      }
    }
    offset += field.bytes();
  }
}

void PcdRows::read_text_row(std::byte* to) {
  std::string_view line, word;
  do {
    const auto next = in_.next_line();
    if (!next) {
      in_.fail_at_line(in_.line(), "the file ends here with fewer rows than the " +
                                       std::to_string(header_.rows) + " points of its header");
    }
    line = *next;
  } while (!LineWords(in_, line).next(word));
  constexpr const char* kNeeded = "every row must have a value for each field";
  LineWords words(in_, line);
  for (const PcdField& field : header_.fields) {
    for (std::size_t i = 0; i < field.count; ++i, to += field.size) {
      if (field.is_padding()) {
        if (!words.next(word)) words.fail(std::string("fewer values than needed; ") + kNeeded);
        continue;
      }
      with_pcd_type(field, [&](auto value) { store(to, words.number<decltype(value)>(kNeeded)); });
    }
  }
  words.require_end(kNeeded);
}

}  // namespace lacuna::io
