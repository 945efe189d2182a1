// SPDX-License-Identifier: Apache-2.0
#include "engine/run/disk_space.hpp"

#include "engine/run/error.hpp"

#include <cstdio>
#include <system_error>

#include <sys/stat.h>

namespace lacuna {

std::optional<Disk> disk_of(const std::filesystem::path& folder) {
  struct stat status {};
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || ::stat(folder.c_str(), &status) != 0) return {};
  return Disk{.number = status.st_dev, .free = space.available};
}

std::string too_small(const std::filesystem::path& folder, const Disk& disk, const std::string& needs) {
  return folder.string() + ": " + print_size(disk.free) + " are free on this disk, and the run needs " +
         needs;
}

void require_space(const std::filesystem::path& workspace, std::uint64_t bytes) {
  const std::optional<Disk> disk = disk_of(workspace);
  if (disk && disk->free < bytes)
    throw Error(too_small(workspace, *disk, "at least " + print_size(bytes)) + kOtherScratch);
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
