#include "engine/core/file.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace lacuna {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action) {
  throw Error(path.string() + ": cannot " + action + ": " + std::strerror(errno));
}

// About a tile's points.
constexpr std::uint64_t kStripe = 4 << 20;

// visit(file, offset in that file, from, count): the parts of [offset, offset + bytes) in each stripe.
template <class Visit>
void for_each_stripe(std::uint64_t offset, std::uint64_t bytes, std::size_t files, Visit&& visit) {
  for (std::uint64_t done = 0; done < bytes;) {
    const std::uint64_t stripe = (offset + done) / kStripe, within = (offset + done) % kStripe;
    const std::uint64_t count = std::min(bytes - done, kStripe - within);
    visit(stripe % files, stripe / files * kStripe + within, done, count);
    done += count;
  }
}

}  // namespace

ScratchFile::ScratchFile(std::filesystem::path path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor_ < 0) fail(path_, "create");
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

ScratchFile::~ScratchFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(path_.c_str());
}

void ScratchFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(path_, "write");
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_, "read");
    if (got == 0) {
      std::memset(bytes.data(), 0, bytes.size());
      return;
    }
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

void StripedFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  for_each_stripe(offset, bytes.size(), kFiles,
                  [&](std::size_t i, std::uint64_t at, std::uint64_t from, std::uint64_t count) {
                    Lazy& lazy = (*files_)[i];
                    std::call_once(lazy.created,
                                   [&] { lazy.file.emplace(path_.string() + "-" + std::to_string(i)); });
                    lazy.file->write(at, bytes.subspan(from, count));
                  });
}

void StripedFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  for_each_stripe(offset, bytes.size(), kFiles,
                  [&](std::size_t i, std::uint64_t at, std::uint64_t from, std::uint64_t count) {
                    const std::optional<ScratchFile>& file = (*files_)[i].file;
                    const std::span<std::byte> part = bytes.subspan(from, count);
                    if (file) {
                      file->read(at, part);
                    } else {
                      std::ranges::fill(part, std::byte{0});
                    }
                  });
}

}  // namespace lacuna
