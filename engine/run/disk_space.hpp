// SPDX-License-Identifier: Apache-2.0
// Checks that a disk has enough space.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lacuna {

// Throws `Error` where this user may write less than `bytes` to the disk of a folder. Does nothing where the
// system does not give the space.
void require_space(const std::filesystem::path& folder, std::uint64_t bytes);

std::string print_size(std::uint64_t bytes);  // "1.5 GiB", for people; exact: print_bytes

}  // namespace lacuna
