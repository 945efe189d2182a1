// SPDX-License-Identifier: Apache-2.0
// What the machine gives to a process: memory, space on its disks, and files that may be opened and read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna {

// Returns the memory in the machine in bytes, or fewer where a control group (a container, a batch system)
// allows fewer.
std::uint64_t machine_memory();

// Returns the least that the control groups of a process allow, of either version. 2^64 - 1: they set no
// limit. `groups` is as /proc/self/cgroup, `root` as /sys/fs/cgroup.
std::uint64_t group_memory(const std::filesystem::path& groups, const std::filesystem::path& root);

// Bytes of the process that are in memory now. `mapped`: bytes of files, the program and its libraries
// included. Zeros where the system does not say. Cost: one system call.
struct ResidentMemory {
  std::uint64_t all, mapped;
};
ResidentMemory resident_memory();

// Returns the most bytes of this process that were in memory so far; 0 where the system does not say.
std::uint64_t peak_memory();

// Throws `Error` where this user may write less than `bytes` to the disk of a folder. Does nothing where the
// system does not give the space.
void require_space(const std::filesystem::path& folder, std::uint64_t bytes);

std::string print_size(std::uint64_t bytes);  // "1.5 GiB", for people; exact: print_bytes

// Throws `Error` unless `file` is a regular file. Must come before the file is opened: to open a named pipe
// waits for a writer, and a device may have no end. `needed` is for the error: "a scan file".
void check_regular_file(const std::filesystem::path& file, std::string_view needed);

}  // namespace lacuna
