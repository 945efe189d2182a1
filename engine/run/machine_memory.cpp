// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t read_limit(const fs::path& file) {
  std::ifstream in(file);
  std::uint64_t limit = 0;
  return in >> limit ? limit : kUnlimited;  // "max", or no such file
}

}  // namespace

std::uint64_t machine_memory() {
  const std::uint64_t physical = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                 static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min(physical, group_memory("/proc/self/cgroup", "/sys/fs/cgroup"));
}

ResidentMemory resident_memory() {
  static const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  char text[96] = {};
  if (::pread(statm, text, sizeof text - 1, 0) <= 0) return {};
  char* field = text;
  std::strtoull(field, &field, 10);  // the size of the address space
  const std::uint64_t page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
                      all = std::strtoull(field, &field, 10), mapped = std::strtoull(field, &field, 10);
  return {all * page, mapped * page};
}

// This does not use getrusage, which counts the process that started this one, too.
std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string key;
    std::uint64_t kilobytes = 0;
    if (words >> key && key == "VmHWM:" && words >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

std::uint64_t group_memory(const fs::path& groups, const fs::path& root) {
  std::uint64_t least = kUnlimited;
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {  // number:controllers:path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool is_unified = controllers.empty();
    if (!is_unified && controllers != "memory") continue;
    const fs::path top = is_unified ? root : root / "memory";
    const char* const file = is_unified ? "memory.max" : "memory.limit_in_bytes";
    // The limits of a group hold for all groups within it. In a container, only the last may exist.
    for (fs::path group = fs::path(line.substr(second + 1)).relative_path();; group = group.parent_path()) {
      least = std::min(least, read_limit(top / group / file));
      if (group.empty()) break;
    }
  }
  return least;
}

}  // namespace lacuna
