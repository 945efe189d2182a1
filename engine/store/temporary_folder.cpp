// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_folder.hpp"

#include "engine/run/error.hpp"
#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna {

namespace fs = std::filesystem;

struct MarkedFolder {
  fs::path path;  // absolute
  Descriptor folder{}, mark{};
  bool is_locked = false;
};

namespace {

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
constexpr int kMark = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
constexpr mode_t kReadableByAll = 0644;  // another user sees whether the process is at work

std::recursive_mutex mutex;  // of the list, and of what must not be half done when a signal ends the process
std::list<MarkedFolder> living;

std::string mark_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return kTemporaryPrefix + name.substr(name.size() - kDrawnDigits);
}

enum class Lock { kTaken, kInUse, kUnknown };

Lock try_lock(const Descriptor& mark) {
  while (::flock(mark.number(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EINTR) return errno == EWOULDBLOCK ? Lock::kInUse : Lock::kUnknown;
  }
  return Lock::kTaken;
}

// Returns nothing, and sets errno, where the folder cannot be made. Then nothing is left. ENOENT: another
// process may have removed the folder because it had no mark yet.
std::optional<MarkedFolder> make(const fs::path& path) {
  if (::mkdir(path.c_str(), S_IRWXU | S_ISVTX) != 0) return std::nullopt;
  MarkedFolder made{.path = path, .folder = Descriptor(::open(path.c_str(), kFolder))};
  const std::string mark = mark_of(path);
  if (made.folder.is_open())
    made.mark = Descriptor(
        ::openat(made.folder.number(), mark.c_str(), O_RDWR | O_CREAT | O_EXCL | kMark, kReadableByAll));
  if (!made.mark.is_open()) {
    const int reason = errno;
    ::rmdir(path.c_str());
    errno = reason;
    return std::nullopt;
  }
  const Lock lock = try_lock(made.mark);
  struct stat status {};
  if (lock == Lock::kInUse || ::fstat(made.mark.number(), &status) != 0 || status.st_nlink == 0) {
    errno = ENOENT;
    return std::nullopt;
  }
  made.is_locked = lock == Lock::kTaken;
  return made;
}

// Removes what the folder holds, but the file `but`. Returns 0, or the reason why something stays.
int empty(const Descriptor& folder, const std::string& but = "");

int remove_entry(const Descriptor& folder, const char* name) {
  if (::unlinkat(folder.number(), name, 0) == 0 || errno == ENOENT) return 0;
  const int reason = errno;
  const Descriptor inner(::openat(folder.number(), name, kFolder));
  if (!inner.is_open()) return reason;
  if (const int inner_reason = empty(inner)) return inner_reason;
  return ::unlinkat(folder.number(), name, AT_REMOVEDIR) == 0 || errno == ENOENT ? 0 : errno;
}

int empty(const Descriptor& folder, const std::string& but) {
  const int again = ::openat(folder.number(), ".", kFolder);
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(again < 0 ? nullptr : ::fdopendir(again), ::closedir);
  if (!entries) return errno;
  int reason = 0;
  while (const dirent* const entry = ::readdir(entries.get())) {
    const std::string name = entry->d_name;
    if (name == "." || name == ".." || name == but) continue;
    if (const int entry_reason = remove_entry(folder, entry->d_name)) reason = entry_reason;
  }
  return reason;
}

// The mark goes last, and is closed before, since NFS renames an open file that is removed. Returns 0, or the
// reason why something stays.
int remove(MarkedFolder& made) {
  const std::string mark = mark_of(made.path);
  if (const int reason = empty(made.folder, mark)) return reason;
  made.mark = Descriptor();
  ::unlinkat(made.folder.number(), mark.c_str(), 0);
  return ::rmdir(made.path.c_str()) == 0 || errno == ENOENT ? 0 : errno;
}

// Other threads may still add files, so removing takes several rounds.
void remove_persistently(MarkedFolder& made) {
  for (int round = 0; round < 100 && remove(made) != 0; ++round)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

// Returns the folders whose names could be those of temporary ones.
std::vector<fs::path> find_folders(const fs::path& parent, const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code error;  // a folder that cannot be read has none
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() == prefix.size() + kDrawnDigits && name.starts_with(prefix) &&
        name.find_first_not_of("0123456789abcdef", prefix.size()) == name.npos)
      found.push_back(parent / name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Returns the mode, or nothing where another user has made it.
std::optional<mode_t> own_mode(const Descriptor& opened) {
  struct stat status {};
  if (::fstat(opened.number(), &status) != 0 || status.st_uid != ::geteuid()) return std::nullopt;
  return status.st_mode;
}

MarkedFolder open_marked(const fs::path& path) {
  MarkedFolder found{.path = path, .folder = Descriptor(::open(path.c_str(), kFolder))};
  if (!found.folder.is_open()) return found;
  const std::string mark = mark_of(path);
  for (const int access : {O_RDWR, O_RDONLY}) {  // some file systems lock only what may be written
    if (!found.mark.is_open())
      found.mark = Descriptor(::openat(found.folder.number(), mark.c_str(), access | kMark));
  }
  return found;
}

}  // namespace

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  const std::lock_guard lock(mutex);  // a signal finds the folder in the list, or not made yet
  for (int round = 0; round < 100; ++round) {
    const fs::path folder = parent / (prefix + random_digits());
    std::optional<MarkedFolder> made = make(fs::absolute(folder));
    if (!made && errno == ENOENT && fs::exists(parent)) continue;
    if (!made) break;
    folder_ = folder;
    made_ = &living.emplace_back(*std::move(made));
    return;
  }
  throw Error(parent.string() + ": cannot make a temporary folder: " + std::strerror(errno));
}

TemporaryFolder::~TemporaryFolder() {
  const std::lock_guard lock(mutex);
  if (remove(*made_) != 0) return;  // it is a remaining folder
  std::erase_if(living, [&](const MarkedFolder& made) { return &made == made_; });
}

bool TemporaryFolder::is_locked() const {
  return made_->is_locked;
}

std::vector<fs::path> remove_leftovers(const fs::path& parent, const std::string& prefix,
                                       const std::function<void(const fs::path&)>& rescue) {
  std::vector<fs::path> in_use;
  for (const fs::path& folder : find_folders(parent, prefix)) {
    MarkedFolder found = open_marked(folder);
    const std::optional<mode_t> mode = own_mode(found.folder);
    if (!found.mark.is_open()) {
      if (mode && (*mode & S_ISVTX)) ::rmdir(folder.c_str());  // if it is empty
      continue;
    }
    const Lock lock = try_lock(found.mark);
    if (lock == Lock::kInUse) in_use.push_back(folder);
    if (lock != Lock::kTaken || !mode || !S_ISREG(own_mode(found.mark).value_or(0))) continue;
    rescue(folder);
    remove(found);
  }
  return in_use;
}

bool is_temporary_folder(const fs::path& folder) {
  return folder.filename().string().size() > kDrawnDigits && open_marked(folder).mark.is_open();
}

fs::path temporary_parent(const std::string& scratch) {
  if (!scratch.empty()) return scratch;
  std::error_code error;
  fs::path folder = fs::temp_directory_path(error);
  if (error) throw Error("TMPDIR names no folder for temporary files: " + error.message());
  return folder;
}

std::vector<RemainingFolder> remaining_folders() {
  const std::lock_guard lock(mutex);
  std::vector<RemainingFolder> remaining;
  for (MarkedFolder& made : living) {
    if (const int reason = remove(made)) remaining.push_back({made.path, std::strerror(reason)});
  }
  return remaining;
}

void remove_temporary_folders() {
  mutex.lock();  // and never unlocked
  for (MarkedFolder& made : living) remove_persistently(made);
}

RemovalPause::RemovalPause() : lock_(mutex) {}

}  // namespace lacuna
