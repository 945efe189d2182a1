// SPDX-License-Identifier: Apache-2.0
#include "tools/run/own_process.hpp"

#include "engine/run/memory.hpp"

#include <algorithm>
#include <cstddef>

#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <tbb/global_control.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

// Gives back the tables of symbols that the dynamic linker has read: 20 MiB, since OpenVDB is linked. The
// system reads them again if they are needed.
void release_symbol_tables() {
  const auto release = [](dl_phdr_info* library, std::size_t, void*) {
    const std::uintptr_t page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    for (int i = 0; i < library->dlpi_phnum; ++i) {
      const auto& segment = library->dlpi_phdr[i];
      if (segment.p_type != PT_LOAD || segment.p_flags != PF_R) continue;  // neither code nor data
      const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
      ::madvise(reinterpret_cast<void*>(begin),
                library->dlpi_addr + segment.p_vaddr + segment.p_memsz - begin, MADV_DONTNEED);
    }
    return 0;
  };
  ::dl_iterate_phdr(release, nullptr);
}

// Large arrays come from the system and go back to it; small ones share few arenas. Without this, memory that
// threads free stays with them, and the process grows beyond its limit. If the limit is far, memory is kept
// and used again, because the system has to clear fresh pages. Within 64 MiB, the least limit, the process
// keeps next to no memory.
void set_up_allocator(std::uint64_t limit) {
  ::mallopt(M_MMAP_THRESHOLD, static_cast<int>(std::clamp(limit / 64, kMiB, 32 * kMiB)));
  ::mallopt(M_TRIM_THRESHOLD,
            static_cast<int>(std::clamp((std::max(limit, 64 * kMiB) - 56 * kMiB) / 8, kMiB, 512 * kMiB)));
  // An arena keeps up to several MiB that nobody uses.
  ::mallopt(M_ARENA_MAX, static_cast<int>(std::clamp<std::uint64_t>(limit / (32 * kMiB), 1, 4)));
}

}  // namespace

void prepare_process(const RunConfig& config) {
  set_up_allocator(Memory::share(config.memory_limit).limit);
  release_symbol_tables();
  if (config.threads > 0) {
    static const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                             static_cast<std::size_t>(config.threads));
  }
}

}  // namespace lacuna::tools
