// SPDX-License-Identifier: Apache-2.0
// The bytes of an E57 file without the checksums between them.
//
// An E57 file is a sequence of pages of one size. The last 4 bytes of a page are the CRC-32C of its data,
// highest byte first. Offsets that the file states are physical: they count checksums. Its lengths are
// logical: they do not count them. ASTM E2807-11; libE57Format reads and writes the checksum in this byte
// order.
#pragma once

#include "io/read/files/input_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lacuna::io {

// Reads at any place; front to back is fastest. Holds about 256 KiB, or one page where that is more.
class PagedFile {
 public:
  static constexpr std::size_t kChecksumBytes = 4;

  // Throws `Error` unless the file can be opened and has whole pages. `page_bytes`: more than kChecksumBytes.
  PagedFile(const std::filesystem::path& file, std::size_t page_bytes);

  std::uint64_t size() const { return size_; }          // in logical bytes
  std::uint64_t position() const { return position_; }  // logical
  // Moves to a physical offset. Throws `Error`, which names it as `what`, unless it is a byte of data.
  void seek(std::uint64_t physical, const std::string& what);
  // Passes over logical bytes, of which the file must have as many.
  void skip(std::uint64_t count);
  // Reads the next bytes. Throws `Error` if the file ends before, or a page's checksum is wrong.
  void read(std::byte* to, std::size_t count);

  // These throw an `Error` that names the file and the physical byte.
  [[noreturn]] void fail(std::uint64_t logical, const std::string& reason) const;
  [[noreturn]] void fail_physical(std::uint64_t physical, const std::string& reason) const;

 private:
  const std::byte* checked_page(std::uint64_t page);
  void load(std::uint64_t page);

  std::unique_ptr<InputFile> in_;  // at the end of the block
  std::size_t page_bytes_;
  std::size_t data_bytes_;  // of a page, without its checksum
  std::uint64_t pages_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::vector<std::byte> block_;     // pages of the file
  std::uint64_t block_begin_ = 0;    // their first
  std::uint64_t block_end_ = 0;      // behind their last
  std::uint64_t checked_pages_ = 0;  // the page before this one has the right checksum; 0 before any check
};

}  // namespace lacuna::io
