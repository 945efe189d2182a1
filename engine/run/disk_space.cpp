// SPDX-License-Identifier: Apache-2.0
#include "engine/run/disk_space.hpp"

#include "engine/run/error.hpp"

#include <cstdio>
#include <system_error>

namespace lacuna {

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

}  // namespace lacuna
