// SPDX-License-Identifier: Apache-2.0
#include "io/results/row_lists.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace lacuna::io {

using Number = std::uint64_t;

RowLists::RowLists(const std::filesystem::path& path, std::size_t lists, std::size_t block)
    : file_(path), data_(block - sizeof(Number)), lists_(lists) {
  assert(block > sizeof(Number));
}

void RowLists::append(std::size_t index, std::span<const std::byte> bytes) {
  List& list = lists_[index];
  if (list.size == 0 && !bytes.empty()) list.first = list.current = blocks_++;
  list.size += bytes.size();
  while (!bytes.empty()) {
    list.buffer.reserve(data_ + sizeof(Number));
    const auto fitting = bytes.first(std::min(bytes.size(), data_ - list.buffer.size()));
    list.buffer.insert(list.buffer.end(), fitting.begin(), fitting.end());
    bytes = bytes.subspan(fitting.size());
    if (list.buffer.size() < data_) return;
    const Number next = blocks_++;
    list.buffer.resize(data_ + sizeof next);
    std::memcpy(&list.buffer[data_], &next, sizeof next);
    file_.write(list.current * list.buffer.size(), list.buffer);
    list.current = next;
    list.buffer.clear();
  }
}

void RowLists::read(std::size_t index, const std::function<void(std::span<const std::byte>)>& visit) const {
  const List& list = lists_[index];
  std::vector<std::byte> block(data_ + sizeof(Number));
  Number at = list.first;
  for (std::uint64_t left = list.size - list.buffer.size(); left > 0; left -= data_) {
    file_.read(at * block.size(), block);
    visit(std::span(block).first(data_));
    std::memcpy(&at, &block[data_], sizeof at);
  }
  if (!list.buffer.empty()) visit(list.buffer);
}

}  // namespace lacuna::io
