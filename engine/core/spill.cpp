#include "engine/core/spill.hpp"

#include <algorithm>

namespace lacuna {

SpillBytes::SpillBytes(std::filesystem::path path, std::size_t lists, std::uint64_t budget)
    : file_(std::move(path)), budget_(std::max<std::uint64_t>(budget, 1 << 16)), lists_(lists) {}

void SpillBytes::append(std::size_t index, std::span<const std::byte> bytes) {
  const std::lock_guard lock(*mutex_);
  List& list = lists_[index];
  const std::size_t before = list.buffer.capacity();
  list.buffer.insert(list.buffer.end(), bytes.begin(), bytes.end());
  list.size += bytes.size();
  buffered_ += list.buffer.capacity() - before;
  if (buffered_ > budget_) relieve();
}

std::uint64_t SpillBytes::size(std::size_t list) const {
  const std::lock_guard lock(*mutex_);
  return lists_[list].size;
}

void SpillBytes::read(std::size_t index, std::uint64_t from, std::uint64_t bytes, std::byte* to) const {
  const std::lock_guard lock(*mutex_);
  const List& list = lists_[index];
  for (const Extent& extent : list.extents) {
    const std::uint64_t skip = std::min(from, extent.size);
    const std::uint64_t taken = std::min(bytes, extent.size - skip);
    file_.read(extent.offset + skip, {to, taken});
    from -= skip;
    bytes -= taken;
    to += taken;
  }
  std::copy_n(list.buffer.begin() + static_cast<std::ptrdiff_t>(from), bytes, to);
}

void SpillBytes::drop(std::size_t index) {
  const std::lock_guard lock(*mutex_);
  buffered_ -= lists_[index].buffer.capacity();
  lists_[index] = List{};
}

void SpillBytes::write_out(List& list) {
  if (list.buffer.empty()) return;
  file_.write(end_, list.buffer);
  if (!list.extents.empty() && list.extents.back().offset + list.extents.back().size == end_) {
    list.extents.back().size += list.buffer.size();
  } else {
    list.extents.push_back({end_, list.buffer.size()});
  }
  end_ += list.buffer.size();
  buffered_ -= list.buffer.capacity();
  std::vector<std::byte>().swap(list.buffer);
}

// Writes the fullest buffers until half of the budget is free.
void SpillBytes::relieve() {
  std::vector<List*> fullest;
  for (List& list : lists_) {
    if (list.buffer.capacity() > 0) fullest.push_back(&list);
  }
  std::sort(fullest.begin(), fullest.end(),
            [](const List* a, const List* b) { return a->buffer.capacity() > b->buffer.capacity(); });
  for (List* list : fullest) {
    if (buffered_ <= budget_ / 2) break;
    write_out(*list);
  }
}

}  // namespace lacuna
