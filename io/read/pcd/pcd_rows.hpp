// SPDX-License-Identifier: Apache-2.0
// The rows of a PCD file as its header describes them, front to back, whatever their encoding.
#pragma once

#include "io/read/pcd/lzf.hpp"
#include "io/read/pcd/pcd_header.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace lacuna::io {

// Memory and errors are as for open_pcd (io/read/pcd/pcd_reader.hpp).
class PcdRows {
 public:
  explicit PcdRows(const std::filesystem::path& file);

  const InputFile& in() const { return in_; }
  const PcdHeader& header() const { return header_; }
  // Reads the next rows in the machine's byte order, at most `max_rows` and no more than 32 MiB. Returns
  // their number, 0 at the end. The content of fields of padding is not defined.
  std::size_t next(std::vector<std::byte>& rows, std::size_t max_rows);

 private:
  std::string_view padding() const;
  void require_size() const;
  [[noreturn]] void fail_too_short() const;
  void open_block();
  void start_columns();
  void read_columns(std::byte* rows, std::size_t count);
  void read_text_row(std::byte* to);

  InputFile in_;
  PcdHeader header_;
  std::uint64_t left_;             // rows not yet read
  std::size_t row_bytes_;          // padding included
  std::uint64_t block_bytes_ = 0;  // compressed
  std::uint64_t unpacked_bytes_ = 0;
  bool has_padding_ = false;        // the block has columns of padding
  std::vector<LzfStream> columns_;  // of the fields but padding, once rows are read
  std::vector<std::byte> column_bytes_;
};

}  // namespace lacuna::io
