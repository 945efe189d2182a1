// SPDX-License-Identifier: Apache-2.0
#include "io/results/output_set.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ranges>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 20;  // of a mark in the first line

[[noreturn]] void fail(const fs::path& name, const std::string& what, int reason) {
  throw Error(name.string() + ": " + what + ": " + std::strerror(reason));
}

void make_folder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0700) != 0) fail(folder, "cannot be made", errno);
}

// What has the name, itself if it is a link; none where nothing has it.
std::optional<struct stat> find(const fs::path& name) {
  struct stat found {};
  if (::lstat(name.c_str(), &found) == 0) return found;
  if (errno != ENOENT && errno != ENOTDIR) fail(name, "cannot be examined", errno);
  return std::nullopt;
}

bool is_same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

// As rename, but fails with EEXIST where `to` has a file; where the file system cannot do that, it is looked
// for first.
int rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return -1;
  if (find(to)) {
    errno = EEXIST;
    return -1;
  }
  return ::rename(from.c_str(), to.c_str());
}

// Names last through a power cut only once their folder is on the disk, too.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(folder, "cannot be opened", errno);
  const int status = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  const bool is_unsupported = reason == EINVAL;  // some network file systems
  if (status != 0 && !is_unsupported) fail(folder, "cannot be written", reason);
}

}  // namespace

bool is_own_file(const fs::path& file, const FileMark& mark) {
  const auto found = find(file);
  if (!found || !S_ISREG(found->st_mode)) return false;  // a pipe or a device is not even opened
  if (!mark.sister.empty())
    return is_own_file(fs::path(file).replace_extension(mark.sister), FileMark(mark.text, mark.fits));
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_in_line = mark.offset == FileMark::kInFirstLine;
  std::string begin(is_in_line ? kLongestLine : mark.fits ? FileMark::kReach : mark.text.size(), '\0');
  const ssize_t length =
      ::pread(descriptor, begin.data(), begin.size(), is_in_line ? 0 : static_cast<off_t>(mark.offset));
  ::close(descriptor);
  begin.resize(length < 0 ? 0 : static_cast<std::size_t>(length));
  if (is_in_line)
    return std::string_view(begin).substr(0, begin.find('\n')).find(mark.text) != std::string_view::npos;
  return begin.starts_with(mark.text) && (!mark.fits || mark.fits(begin));
}

void check_output(const fs::path& file, const FileMark& mark, Overwrite overwrite) {
  if (!file.has_filename()) throw Error("\"" + file.string() + "\": a file name is needed");
  const auto found = find(file);
  if (!found) return;
  if (!S_ISREG(found->st_mode)) {
    throw Error(file.string() + ": is " + kind_of(found->st_mode) +
                "; only regular files are replaced: remove it, or choose another place");
  }
  if (overwrite == Overwrite::kOwn && !is_own_file(file, mark)) {
    throw Error(
        file.string() +
        ": exists, and this command did not write it; choose another place, or replace it with --overwrite");
  }
}

OutputFile& OutputSet::add(const fs::path& file, const FileMark& mark, Writer writer) {
  const auto found = find(file);
  check_output(file, mark, overwrite_);
  Member& member = join(file, found);
  return member.content.emplace(member.name, member.staged, writer);
}

void OutputSet::drop(const fs::path& file, const FileMark& mark) {
  const auto found = find(file);
  if (is_own_file(file, mark)) join(file, found);
}

OutputSet::Member& OutputSet::join(const fs::path& file, const std::optional<struct stat>& found) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const auto [at, is_made] = private_folders_.try_emplace(folder, folder, kTemporaryPrefix);
  const fs::path staging = at->second.path() / "new", aside = at->second.path() / "old";
  if (is_made) {
    for (const fs::path& part : {staging, aside}) make_folder(part);
  }
  Member& member = members_.emplace_back();
  member.name = file;
  member.found = found;
  member.folder = &at->second;
  member.staged = staging / file.filename();
  member.older = aside / file.filename();
  return member;
}

std::vector<fs::path> OutputSet::commit() {
  for (Member& member : members_) {
    if (member.content && !member.content->close()) member.content.reset();
  }
  const RemovalPause pause;
  try {
    for (Member& member : members_ | std::views::reverse) set_aside(member);
    for (Member& member : members_) put_in_place(member);
    for (const auto& [folder, staging] : private_folders_) sync_folder(folder);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + put_back());
  }
  std::vector<fs::path> written;
  for (const Member& member : members_) {
    if (member.is_in_place) written.push_back(member.name);
  }
  return written;
}

void OutputSet::set_aside(Member& member) {
  if (::rename(member.name.c_str(), member.older.c_str()) != 0) {
    if (errno == ENOENT) return;  // nothing was there, or it has gone meanwhile
    fail(member.name, "cannot be replaced", errno);
  }
  member.is_aside = true;
  const auto moved = find(member.older);
  if (!member.found || !moved || !is_same_file(*moved, *member.found))
    throw Error(member.name.string() +
                ": another program has written it during the run; it stays, without new results");
}

void OutputSet::put_in_place(Member& member) {
  if (!member.content) return;
  if (rename_to_free_name(member.staged, member.name) != 0)
    fail(member.name, "cannot be put in place", errno);
  member.is_in_place = true;
}

// Undoes a commit; returns what an error has to add.
std::string OutputSet::put_back() {
  std::string lost;
  for (Member& member : members_ | std::views::reverse) {
    if (member.is_in_place) ::rename(member.name.c_str(), member.staged.c_str());
    if (!member.is_aside || rename_to_free_name(member.older, member.name) == 0) continue;
    lost += "; the earlier " + member.name.filename().string() + " is kept as " + member.older.string();
    member.folder->keep();
  }
  return lost;
}

}  // namespace lacuna::io
