// SPDX-License-Identifier: Apache-2.0
// Many lists of bytes on their way to files, in the order in which they were put. AppendBytes
// (engine/store/append_lists.hpp) does not keep the order of what it reads in parts.
//
// Each list has a buffer of one block in memory. A full block goes to the one temporary file. It ends with
// the number of the list's next block, which is reserved at that moment. So in memory a list is its buffer
// and 56 bytes, however long it is.
#pragma once

#include "engine/store/store_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::io {

class RowLists {
 public:
  // `path` must not exist: the file has no name after that. `block` bytes are held for each list that is not
  // empty. Throws `Error`.
  RowLists(const std::filesystem::path& path, std::size_t lists, std::size_t block);

  // One thread at a time may call it. Throws `Error`.
  void append(std::size_t list, std::span<const std::byte> bytes);
  std::uint64_t size(std::size_t list) const { return lists_[list].size; }  // bytes
  // Calls visit with all bytes of the list in order, in pieces. Throws `Error`.
  void read(std::size_t list, const std::function<void(std::span<const std::byte>)>& visit) const;

 private:
  struct List {
    std::vector<std::byte> buffer;         // the bytes behind the full blocks
    std::uint64_t first = 0, current = 0;  // blocks; an empty list has none
    std::uint64_t size = 0;
  };

  StoreFile file_;
  std::size_t data_;          // bytes of a block without the number at its end
  std::uint64_t blocks_ = 0;  // reserved
  std::vector<List> lists_;
};

}  // namespace lacuna::io
