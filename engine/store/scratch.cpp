// SPDX-License-Identifier: Apache-2.0
#include "engine/store/scratch.hpp"

#include "engine/run/machine.hpp"
#include "engine/store/store_file.hpp"

#include <algorithm>
#include <atomic>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace lacuna {
namespace {

std::string unique_name() {
  static std::atomic<unsigned> count{0};
  return "scratch-" + std::to_string(count++);
}

}  // namespace

Scratch::Scratch(std::filesystem::path folder, std::uint64_t budget)
    : folder_(std::move(folder)), budget_(budget), between_looks_(std::max(budget / 8, 16 * kWindow)) {}

Scratch::~Scratch() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.address, mapping.bytes);
}

std::byte* Scratch::allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  if (in_memory_ + bytes <= budget_) {
    in_memory_ += bytes;
    return blocks_.emplace_back(new std::byte[bytes]()).get();
  }
  if (mappings_.empty()) most_mapped_ = resident_memory().mapped + budget_ - in_memory_;
  // The mapping alone keeps the file: it has no name and no descriptor by which anyone could cut it short.
  std::byte* const address = StoreFile(folder_ / unique_name()).map(bytes);
  ::madvise(address, bytes, MADV_RANDOM);  // no read-around: a fault brings in that page only
  mappings_.push_back({address, bytes});
  return address;
}

// All mapped pages are given back at once: a few at a time would be given back again and again. Other
// mappings of the process count, too, so the next time is half a budget later at the earliest.
void Scratch::release() {
  untrimmed_ = 0;
  if (mappings_.empty() || resident_memory().mapped < most_mapped_) return;
  for (const Mapping& mapping : mappings_) ::madvise(mapping.address, mapping.bytes, MADV_DONTNEED);
  most_mapped_ = std::max(most_mapped_, resident_memory().mapped + budget_ / 2);
}

}  // namespace lacuna
