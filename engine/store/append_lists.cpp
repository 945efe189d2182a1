// SPDX-License-Identifier: Apache-2.0
#include "engine/store/append_lists.hpp"

#include "engine/run/error.hpp"

#include <cstring>

namespace lacuna {

AppendBytes::AppendBytes(const Spill& spill, std::string_view name, std::size_t lists)
    : pool_(spill.buffers), path_(spill.file(name)) {
  pool_->enter(*this);
  add_lists(lists);
}

AppendBytes::~AppendBytes() {
  pool_->leave(*this);
}

void AppendBytes::add_lists(std::size_t count) {
  const std::lock_guard lock(mutex_);
  lists_.resize(lists_.size() + count);
  pool_->grow_table(*this, count * sizeof(List));
}

void AppendBytes::append(std::size_t index, std::span<const std::byte> bytes) {
  add_to_buffer(index, bytes);
  pool_->relieve();
}

void AppendBytes::add_to_buffer(std::size_t index, std::span<const std::byte> bytes) {
  const std::lock_guard lock(mutex_);
  List& list = lists_[index];
  const std::size_t before = list.buffer.capacity();
  if (list.buffer.empty()) {
    list.buffer.reserve(sizeof(Extent) + bytes.size());
    list.buffer.resize(sizeof(Extent));
  }
  list.buffer.insert(list.buffer.end(), bytes.begin(), bytes.end());
  list.size += bytes.size();
  pool_->grow(*this, list.buffer.capacity() - before);
}

std::uint64_t AppendBytes::size(std::size_t list) const {
  const std::lock_guard lock(mutex_);
  return lists_[list].size;
}

// Calls take_tail(place, bytes) with the bytes in memory, under the lock. Then it calls take_extent(place,
// extent) for each extent, the last first, without the lock.
template <class TakeTail, class TakeExtent>
void AppendBytes::walk(std::size_t index, TakeTail&& take_tail, TakeExtent&& take_extent) const {
  std::uint64_t end;  // of what is not taken yet
  Extent extent;
  {
    const std::lock_guard lock(mutex_);
    const List& list = lists_[index];
    end = list.size - list.tail().size();
    extent = list.last;
    take_tail(end, list.tail());
  }
  while (end > 0) {
    if (extent.size == 0 || extent.size > end)
      throw Error(path_.string() + ": the file was changed during the run: a list of it is broken");
    end -= extent.size;
    take_extent(end, extent);
    if (end > 0) file_->read(extent.offset - sizeof(Extent), std::as_writable_bytes(std::span(&extent, 1)));
  }
}

void AppendBytes::read(std::size_t list, std::byte* to) const {
  walk(
      list, [&](std::uint64_t place, auto tail) { std::copy(tail.begin(), tail.end(), to + place); },
      [&](std::uint64_t place, const Extent& extent) {
        file_->read(extent.offset, {to + place, extent.size});
      });
}

void AppendBytes::for_each_block(std::size_t list, std::size_t block_bytes,
                                 const std::function<void(std::span<const std::byte>)>& visit) const {
  std::vector<std::byte> last, space(std::min<std::uint64_t>(block_bytes, size(list)));
  const auto in_blocks = [&](std::uint64_t size, auto&& block_at) {
    for (std::uint64_t from = 0; from < size; from += space.size())
      visit(block_at(from, std::min<std::uint64_t>(space.size(), size - from)));
  };
  walk(
      list, [&](std::uint64_t, auto tail) { last.assign(tail.begin(), tail.end()); },
      [&](std::uint64_t, const Extent& extent) {
        in_blocks(extent.size, [&](std::uint64_t from, std::uint64_t count) {
          const auto block = std::span(space).first(count);
          file_->read(extent.offset + from, block);
          return block;
        });
      });
  in_blocks(last.size(),
            [&](std::uint64_t from, std::uint64_t count) { return std::span(last).subspan(from, count); });
}

void AppendBytes::drop(std::size_t index) {
  const std::lock_guard lock(mutex_);
  pool_->shrink(*this, lists_[index].buffer.capacity());
  lists_[index] = List{};
}

void AppendBytes::write_half() {
  const std::lock_guard lock(mutex_);
  std::vector<List*> fullest;
  for (List& list : lists_) {
    if (list.buffer.capacity() > 0) fullest.push_back(&list);
  }
  std::sort(fullest.begin(), fullest.end(),
            [](const List* a, const List* b) { return a->buffer.capacity() > b->buffer.capacity(); });
  const std::uint64_t half = held() / 2;
  for (List* list : fullest) {
    if (held() <= half) break;
    write_out(*list);
  }
}

void AppendBytes::write_out(List& list) {
  std::memcpy(list.buffer.data(), &list.last, sizeof(Extent));
  if (!file_) file_.emplace(path_);
  const std::uint64_t offset = file_->append(list.buffer);
  list.last = {offset + sizeof(Extent), list.tail().size()};
  pool_->shrink(*this, list.buffer.capacity());
  std::vector<std::byte>().swap(list.buffer);
}

}  // namespace lacuna
