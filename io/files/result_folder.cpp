// SPDX-License-Identifier: Apache-2.0
#include "io/files/result_folder.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = ".lacuna";  // of the names of all files, a line each

[[noreturn]] void fail(const fs::path& name, const std::string& what, int reason) {
  throw Error(name.string() + ": " + what + ": " + std::strerror(reason));
}

std::set<std::string> listed_files(const fs::path& folder) {
  std::set<std::string> names;
  std::ifstream list(folder / kList);
  for (std::string line; std::getline(list, line);) names.insert(line);
  return names;
}

// Returns the names of all files in a folder and in its folders. A link is a file.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const bool is_folder = entry->symlink_status(error).type() == fs::file_type::directory;
    if (!is_folder || fs::is_empty(entry->path(), error))
      names.push_back(entry->path().lexically_relative(folder).string());
  }
  if (error) throw Error(folder.string() + ": cannot be read: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

// No rename can replace it.
bool is_mount_point(const fs::path& folder) {
  struct statx found {};
  return ::statx(AT_FDCWD, folder.c_str(), AT_SYMLINK_NOFOLLOW, 0, &found) == 0 &&
         (found.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

// Returns the files of an earlier result. Throws `Error` where the folder holds anything else.
std::vector<std::string> replaced_files(const fs::path& target, const fs::path& shown) {
  const fs::file_status status = fs::symlink_status(target);
  if (!fs::exists(status)) return {};
  if (status.type() != fs::file_type::directory) throw Error(shown.string() + ": not a folder");
  std::vector<std::string> files = files_in(target);
  const std::set<std::string> listed = listed_files(target);
  for (const std::string& name : files) {
    const bool is_regular = fs::symlink_status(target / name).type() == fs::file_type::regular;
    if (name != kList && (!is_regular || !listed.contains(name)))
      throw Error((shown / name).string() +
                  ": is no result of an earlier run, and the results replace all of the folder; allowed: a "
                  "new or empty folder, or one that has earlier results alone");
  }
  return files;
}

// Names last through a power cut only once their folder is on the disk, too.
void sync_folder(const fs::path& folder, int (*sync)(int)) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(folder, "cannot be opened", errno);
  const int reason = sync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (reason != 0 && reason != EINVAL) fail(folder, "cannot be written", reason);
}

// Gives `from` the name `to`. A folder of that name moves to `aside`, or takes the name `from`.
void exchange(const fs::path& from, const fs::path& to, const fs::path& aside, const fs::path& shown) {
  if (::rename(from.c_str(), to.c_str()) == 0) return;  // the name is free, or of an empty folder
  if (errno != ENOTEMPTY && errno != EEXIST) fail(shown, "the results cannot be put in place", errno);
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) fail(shown, "the results cannot be put in place", errno);
  if (::rename(to.c_str(), aside.c_str()) != 0) fail(shown, "the earlier results cannot be moved", errno);
  if (::rename(from.c_str(), to.c_str()) == 0) return;
  const int reason = errno;
  ::rename(aside.c_str(), to.c_str());
  fail(shown, "the results cannot be put in place", reason);
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& folder) : folder_(folder) {
  std::error_code error;
  if (fs::is_symlink(folder, error) && !fs::exists(folder, error))
    throw Error(folder.string() + ": a link to " + fs::read_symlink(folder).string() +
                ", which is missing; allowed: a folder, or a name that is free");
  target_ = fs::weakly_canonical(fs::absolute(folder), error);
  if (!target_.has_filename()) target_ = target_.parent_path();
  if (error || !target_.has_filename())
    throw Error("\"" + folder.string() + "\": the name of a folder is needed");
  replaced_files(target_, folder);
  if (is_mount_point(target_))
    throw Error(folder.string() +
                ": is a mount point, which results cannot replace; allowed: a folder in it, such as " +
                (folder / "holes").string());
  const bool exists = fs::exists(target_);
  if (exists && ::access(target_.c_str(), W_OK | X_OK) != 0)
    fail(folder, "cannot write to the folder", errno);
  fs::create_directories(target_.parent_path(), error);
  if (error) throw Error(target_.parent_path().string() + ": cannot create the folder: " + error.message());

  root_ = target_.parent_path() / ("." + target_.filename().string() + kList);
  do {
    if (::mkdir(root_.c_str(), 0777) != 0 && errno != EEXIST) fail(folder, "cannot create the folder", errno);
    lock_.reset();
    lock_.emplace(root_);
  } while (!lock_->holds(root_));
  temporary_.emplace(root_);
  if (!fs::create_directory(staged(), error)) fail(staged(), "cannot be made", error.value());
  if (exists) fs::permissions(staged(), fs::status(target_).permissions(), error);
}

ResultFolder::~ResultFolder() = default;

std::vector<fs::path> ResultFolder::earlier_files() const {
  std::vector<fs::path> files;
  for (const std::string& name : replaced_files(target_, folder_)) files.push_back(folder_ / name);
  return files;
}

std::unique_ptr<OutputFile> ResultFolder::open(const std::string& name, Writer writer) const {
  const fs::path place = staged() / name;
  std::error_code error;
  fs::create_directories(place.parent_path(), error);
  if (error) fail(folder_ / name, "its folder cannot be made", error.value());
  return std::make_unique<OutputFile>(folder_ / name, place, writer);
}

void ResultFolder::add(const std::string& name, const std::function<void(OutputFile& out)>& write,
                       Writer writer) const {
  const std::unique_ptr<OutputFile> out = open(name, writer);
  write(*out);
  out->close();
}

std::vector<fs::path> ResultFolder::commit() {
  add(kList, [&](OutputFile& list) {
    for (const std::string& name : files_in(staged())) {
      if (name != kList) list.write(name + "\n");
    }
  });
  std::vector<fs::path> written;
  for (const auto& entry : fs::directory_iterator(staged())) {
    if (entry.path().filename() != kList) written.push_back(folder_ / entry.path().filename());
  }
  std::sort(written.begin(), written.end());
  sync_folder(staged(), ::syncfs);
  const RemovalPause pause;
  replaced_files(target_, folder_);
  exchange(staged(), target_, root_ / "earlier", folder_);
  sync_folder(target_.parent_path(), ::fsync);
  return written;
}

bool is_result_folder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kList, error);
}

void note_result(const fs::path& folder, const std::string& name) {
  const std::set<std::string> listed = listed_files(folder);
  if (listed.empty() || listed.contains(name)) return;
  std::ofstream list(folder / kList, std::ios::app);
  if (!(list << name << "\n" << std::flush)) throw Error((folder / kList).string() + ": cannot be written");
}

}  // namespace lacuna::io
