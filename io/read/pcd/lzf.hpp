// SPDX-License-Identifier: Apache-2.0
// LZF, the compression of PCD files, read front to back in bounded memory.
//
// A block is a sequence of steps. A first byte below 32 is followed by that many bytes and one more, as they
// are. Any other first byte repeats earlier output. Its upper three bits are the length less 2 (7: the next
// byte is added). The lower five and the last byte are the distance less 1.
// http://oldhome.schmorp.de/marc/liblzf.html
#pragma once

#include "io/read/files/input_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace lacuna::io {

// The longest repetition, 264 bytes, takes 3 bytes.
inline constexpr std::uint64_t kLzfLargestRatio = 88;

// Holds about 70 KiB. Data that breaks the format is an `Error` that names the file and the byte.
class LzfStream {
 public:
  // Begins the block of `packed` bytes at byte `begin` of the file, which must come to `unpacked` bytes.
  LzfStream(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t packed,
            std::uint64_t unpacked);

  // Returns a second stream that goes on from here on its own.
  LzfStream fork() const;

  void read(std::byte* to, std::size_t count);
  void skip(std::uint64_t count);
  // Throws `Error` unless the block ends here.
  void require_end() const;

 private:
  std::size_t take(std::uint64_t count);  // how many bytes, from begin_ on, are ready; at least 1
  void unpack();
  void unpack_chunk();

  std::unique_ptr<InputFile> in_;
  std::uint64_t packed_left_;
  std::uint64_t unpacked_;
  std::uint64_t unpacked_left_;   // not yet in `bytes_`
  std::vector<std::byte> bytes_;  // what may be repeated, then bytes not yet taken
  std::size_t begin_ = 0;         // not yet taken
  std::size_t end_ = 0;
};

}  // namespace lacuna::io
