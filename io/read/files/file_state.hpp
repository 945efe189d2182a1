// SPDX-License-Identifier: Apache-2.0
// Whether a file is still the one that was read before, with the same content.
#pragma once

#include "engine/store/digest.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

namespace lacuna::io {

struct FileState {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;  // bytes
  std::int64_t mtime = 0;  // nanoseconds since 1970, as ctime
  std::int64_t ctime = 0;  // of the last change to content, name, owner or permissions; no program sets it
};

// Returns device and inode of what a name stands for; nothing if there is nothing.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;
std::optional<FileIdentity> find_identity(const std::filesystem::path& file);

// Throws `Error` if there is no such file.
FileState file_state(const std::filesystem::path& file);

// Returns the digest of some blocks spread over the file, with the first and the last. Throws `Error`.
Digest sample_digest(const std::filesystem::path& file, const FileState& state);

// Throws `Error`, with the difference, unless the file has the state that it had `before`. The check misses
// content of the same length that is written within the clock tick of `before` (milliseconds).
void check_unchanged(const std::filesystem::path& file, const FileState& before);

}  // namespace lacuna::io
