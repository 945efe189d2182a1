#include "engine/store/scratch.hpp"

#include "engine/store/scratch_file.hpp"

#include <algorithm>
#include <atomic>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace lacuna {
namespace {

// Calls of trim() between two measurements of what is resident. A fault may map a 64 KiB window of pages.
constexpr std::uint64_t kTrims = 256;

// Pieces of each mapping that are given back in turn: most of what is in use stays.
constexpr std::uint64_t kParts = 8;

// Bytes of mapped files that are resident in this process.
std::uint64_t resident_mapped() {
  static const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  char text[96] = {};
  if (::pread(statm, text, sizeof text - 1, 0) <= 0) return 0;
  std::istringstream fields(text);
  std::uint64_t total = 0, resident = 0, shared = 0;
  fields >> total >> resident >> shared;
  return shared * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string unique_name() {
  static std::atomic<unsigned> count{0};
  return "scratch-" + std::to_string(count++);
}

}  // namespace

Scratch::Scratch(std::filesystem::path folder, std::uint64_t budget)
    : folder_(std::move(folder)), budget_(budget), trims_left_(kTrims) {}

Scratch::~Scratch() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.address, mapping.bytes);
}

std::byte* Scratch::allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  if (in_memory_ + bytes <= budget_) {
    in_memory_ += bytes;
    return blocks_.emplace_back(new std::byte[bytes]()).get();
  }
  if (mappings_.empty()) mapped_before_ = resident_mapped();
  // The mapping alone keeps the file: it has no name and no descriptor by which anyone could cut it short.
  std::byte* const address = ScratchFile(folder_ / unique_name()).map(bytes);
  ::madvise(address, bytes, MADV_RANDOM);  // no read-around: a fault brings in its page alone
  mappings_.push_back({address, bytes});
  return address;
}

void Scratch::release() {
  trims_left_ = kTrims;
  if (mappings_.empty() || resident_mapped() < mapped_before_ + budget_ - in_memory_) return;
  const std::uint64_t page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  for (const Mapping& mapping : mappings_) {
    const std::uint64_t part = (mapping.bytes / kParts / page + 1) * page;
    const std::uint64_t from = std::min<std::uint64_t>(next_part_ * part, mapping.bytes / page * page);
    ::madvise(mapping.address + from, std::min<std::uint64_t>(part, mapping.bytes - from), MADV_DONTNEED);
  }
  next_part_ = (next_part_ + 1) % kParts;
}

}  // namespace lacuna
