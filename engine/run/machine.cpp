// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
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

void require_space(const std::filesystem::path& folder, std::uint64_t bytes) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || space.available >= bytes) return;
  throw Error(folder.string() + ": " + print_size(space.available) +
              " are free on this disk, and the run needs at least " + print_size(bytes) +
              "; --scratch names a folder on another one");
}

std::string print_size(std::uint64_t bytes) {
  constexpr const char* kNames[] = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  double size = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  while (size >= 1024) {
    size /= 1024;
    ++unit;
  }
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, size < 10 ? "%.1f %s" : "%.0f %s", size, kNames[unit]);
  return buffer;
}

void check_regular_file(const std::filesystem::path& file, std::string_view needed) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    const std::string name = file.string();
    // A path made shorter has one slash of an address.
    for (const char* begin : {"http:/", "https:/", "ftp:/", "s3:/", "gs:/", "az:/"}) {
      if (name.find(begin) == 0)
        throw Error(name + ": is an address, which is not read; download it first, as with curl -O");
    }
    throw Error(name + ": cannot be opened: " + std::strerror(errno));
  }
  if (S_ISREG(status.st_mode)) return;
  const std::string what = S_ISDIR(status.st_mode) ? "is a folder" : "is not a regular file";
  throw Error(file.string() + ": " + what + "; " + std::string(needed) + " is needed");
}

}  // namespace lacuna
