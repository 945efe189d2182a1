// SPDX-License-Identifier: Apache-2.0
// Finds how much space the disk of a folder has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace lacuna {

struct Disk {
  std::uint64_t number = 0;  // folders with the same number share the free space
  std::uint64_t free = 0;    // bytes that this user may write
};

// Returns the disk, and nothing where the system does not give the space.
std::optional<Disk> disk_of(const std::filesystem::path& folder);

// Returns the line that says that the disk of a folder has too little; `needs`: "at least 3 GiB".
std::string too_small(const std::filesystem::path& folder, const Disk& disk, const std::string& needs);
inline constexpr const char* kOtherScratch = "; --scratch names a folder on another one";

// Throws `Error` where the disk of the workspace has less than `bytes`.
void require_space(const std::filesystem::path& workspace, std::uint64_t bytes);

std::string print_size(std::uint64_t bytes);  // "1.5 GiB", for people; exact: print_bytes

}  // namespace lacuna
