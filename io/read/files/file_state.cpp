// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/file_state.hpp"

#include "engine/run/error.hpp"
#include "engine/run/regular_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <sys/stat.h>

namespace lacuna::io {
namespace {

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

// Returns nothing if the system cannot give the file's state; errno says why.
std::optional<FileState> look_up(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileState{.device = status.st_dev,
                   .inode = status.st_ino,
                   .size = static_cast<std::uint64_t>(status.st_size),
                   .mtime = nanoseconds(status.st_mtim),
                   .ctime = nanoseconds(status.st_ctim)};
}

// Returns an empty text if nothing differs.
std::string difference(const FileState& before, const std::optional<FileState>& now) {
  if (!now) return std::string("it cannot be found any more: ") + std::strerror(errno);
  if (now->device != before.device || now->inode != before.inode) return "another file has taken its place";
  if (now->size != before.size) {
    return "it had " + std::to_string(before.size) + " bytes and has " + std::to_string(now->size) + " now";
  }
  if (now->mtime != before.mtime) return "it was written to";
  return now->ctime != before.ctime ? "its content, names, owner or permissions were changed" : "";
}

}  // namespace

std::optional<FileIdentity> find_identity(const std::filesystem::path& file) {
  const std::optional<FileState> state = look_up(file);
  return state ? std::optional(FileIdentity(state->device, state->inode)) : std::nullopt;
}

FileState file_state(const std::filesystem::path& file) {
  const auto state = look_up(file);
  if (!state) check_regular_file(file, "a scan file");  // says of an address that it is one
  if (!state) throw Error(file.string() + ": cannot be opened: " + std::strerror(errno));
  return *state;
}

Digest sample_digest(const std::filesystem::path& file, const FileState& state) {
  constexpr std::uint64_t kBlocks = 16, kBlock = 64 << 10;
  std::ifstream in(file, std::ios::binary);
  std::vector<char> sample;
  for (std::uint64_t i = 0; i < kBlocks; ++i) {
    const std::uint64_t last = state.size - std::min(state.size, kBlock);
    const std::size_t before = sample.size();
    sample.resize(before + std::min(state.size, kBlock));
    in.seekg(static_cast<std::streamoff>(last / (kBlocks - 1) * i));
    in.read(&sample[before], static_cast<std::streamsize>(sample.size() - before));
  }
  if (!in) throw Error(file.string() + ": cannot be read: " + std::strerror(errno));
  return digest_of(std::as_bytes(std::span(sample)));
}

void check_unchanged(const std::filesystem::path& file, const FileState& before) {
  const std::string different = difference(before, look_up(file));
  if (different.empty()) return;
  throw Error(file.string() + ": has changed during the run (" + different +
              "); an input must stay as it is until the run ends");
}

}  // namespace lacuna::io
