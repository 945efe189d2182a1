// SPDX-License-Identifier: Apache-2.0
#include "io/read/files/output_file.hpp"

#include "engine/run/error.hpp"
#include "engine/store/store_file.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::io {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

OutputFile::OutputFile(std::filesystem::path name, const std::filesystem::path& place, Writer writer)
    : name_(std::move(name)), place_(place), writer_(writer) {
  if (writer == Writer::kLibrary) return;
  descriptor_ = ::open(place.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created", errno);
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::span<const std::byte> bytes) {
  assert(descriptor_ >= 0);
  while (!bytes.empty()) {
    const auto fitting = bytes.first(std::min(bytes.size(), kBufferBytes - buffer_.size()));
    buffer_.insert(buffer_.end(), fitting.begin(), fitting.end());
    bytes = bytes.subspan(fitting.size());
    if (buffer_.size() == kBufferBytes) flush();
  }
}

void OutputFile::overwrite(std::uint64_t at, std::span<const std::byte> bytes) {
  flush();
  assert(at + bytes.size() <= end_);
  put(at, bytes);
}

void OutputFile::flush() {
  put(end_, buffer_);
  end_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::put(std::uint64_t at, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written", written < 0 ? errno : ENOSPC);
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

bool OutputFile::close() {
  if (writer_ == Writer::kLibrary) {
    descriptor_ = ::open(place_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor_ < 0 && errno == ENOENT) return false;
    if (descriptor_ < 0) fail("cannot be written", errno);
  }
  if (descriptor_ < 0) return true;
  if (writer_ == Writer::kThis) flush();
  if (::fsync(descriptor_) != 0) fail("cannot be written", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written", errno);
  return true;
}

void OutputFile::fail(const char* what, int reason) const {
  throw Error(name_.string() + ": " + what + ": " + std::strerror(reason));
}

namespace {

namespace fs = std::filesystem;

// Returns the kind of the file that has the name, of a link itself; nothing if no file has it.
std::optional<mode_t> find(const fs::path& name) {
  struct stat found {};
  if (::lstat(name.c_str(), &found) == 0) return found.st_mode;
  if (errno != ENOENT && errno != ENOTDIR)
    throw Error(name.string() + ": cannot be examined: " + std::strerror(errno));
  return std::nullopt;
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

bool has_mark(const fs::path& file, const FileMark& mark) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return false;
  std::string begin(mark.text.size(), '\0');
  const ssize_t length = ::pread(descriptor, begin.data(), begin.size(), static_cast<off_t>(mark.offset));
  ::close(descriptor);
  return length == static_cast<ssize_t>(begin.size()) && begin == mark.text;
}

}  // namespace

void check_output(const fs::path& file, const FileMark& mark, Overwrite overwrite) {
  if (!file.has_filename()) throw Error("\"" + file.string() + "\": a file name is needed");
  const std::optional<mode_t> found = find(file);
  if (!found) return;
  if (!S_ISREG(*found))
    throw Error(file.string() + ": is " + kind_of(*found) +
                "; only regular files are replaced: remove it, or choose another place");
  if (overwrite == Overwrite::kOwn && !has_mark(file, mark))
    throw Error(
        file.string() +
        ": exists, and this command did not write it; choose another place, or replace it with --overwrite");
}

NewFile::NewFile(const fs::path& file, const FileMark& mark, Overwrite overwrite)
    : file_((check_output(file, mark, overwrite), file)),
      mark_(mark),
      overwrite_(overwrite),
      folder_(file.has_parent_path() ? file.parent_path() : ".", kTemporaryPrefix),
      content_(file, folder_.path() / "new") {
  remove_leftovers(folder_.path().parent_path(), kTemporaryPrefix);
}

void NewFile::commit() {
  content_.close();
  const RemovalPause pause;
  check_output(file_, mark_, overwrite_);
  if (::rename(content_.place().c_str(), file_.c_str()) != 0)
    throw Error(file_.string() + ": cannot be put in place: " + std::strerror(errno));
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kList = ".lacuna";  // of the names of all files, a line each
constexpr const char* kEarlier = "earlier";

[[noreturn]] void fail(const fs::path& name, const std::string& what, int reason) {
  throw Error(name.string() + ": " + what + ": " + std::strerror(reason));
}

[[noreturn]] void fail_in_use(const fs::path& folder) {
  throw Error(folder.string() + ": another run is at work there");
}

bool is_regular(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() == fs::file_type::regular;
}

std::set<std::string> listed_files(const fs::path& folder) {
  std::set<std::string> names;
  if (!is_regular(folder / kList)) return names;
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

// Returns whether another program keeps `companion` as a lock or a journal while it has `file` open.
bool is_companion(const fs::path& companion, const fs::path& file) {
  struct Form {
    std::string_view before, after;
  };
  static constexpr Form kForms[] = {{".~lock.", "#"},                                  // LibreOffice
                                    {"", "-wal"},     {"", "-shm"}, {"", "-journal"},  // SQLite
                                    {"~$", ""},                                        // Microsoft Office
                                    {".", ".swp"},    {".#", ""}};                     // Vim, Emacs
  const std::string name = file.filename().string(), beside = companion.filename().string();
  const auto is_of_form = [&](const Form& form) {
    return beside == std::string(form.before) + name + std::string(form.after);
  };
  // Microsoft Word leaves out the first two characters.
  const bool is_of_word = name.size() > 2 && beside == "~$" + name.substr(2);
  return companion.parent_path() == file.parent_path() &&
         (is_of_word || std::ranges::any_of(kForms, is_of_form));
}

// Returns the files of an earlier result. Throws `Error` where the folder holds anything else.
std::vector<std::string> replaced_files(const fs::path& target, const fs::path& shown) {
  const fs::file_status status = fs::symlink_status(target);
  if (!fs::exists(status)) return {};
  if (status.type() != fs::file_type::directory) throw Error(shown.string() + ": not a folder");
  std::vector<std::string> files = files_in(target);
  const std::set<std::string> listed = listed_files(target);
  for (const std::string& name : files) {
    if (is_regular(target / name) && (name == kList || listed.contains(name))) continue;
    const auto is_beside = [&](const std::string& file) { return is_companion(name, file); };
    if (const auto open = std::ranges::find_if(listed, is_beside); open != listed.end())
      throw Error((shown / name).string() + ": " + *open +
                  " is open in another program; allowed: close it there, or, if no program has it open, "
                  "remove this file");
    throw Error((shown / name).string() +
                ": is no result of an earlier run, and the results replace all of the folder; allowed: a "
                "new or empty folder, or one that has earlier results alone");
  }
  return files;
}

// Names last through a power cut only once their folder is on the disk, too.
void sync_folder(const fs::path& folder, int (*sync)(int)) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.is_open()) fail(folder, "cannot be opened", errno);
  if (sync(opened.number()) != 0 && errno != EINVAL) fail(folder, "cannot be written", errno);
}

// Gives `from` the name `to`. A folder of that name goes to `from`, or to `aside`.
void exchange(const fs::path& from, const fs::path& to, const fs::path& aside, const fs::path& shown) {
  if (::rename(from.c_str(), to.c_str()) == 0) return;  // the name is free, or of an empty folder
  if (errno != ENOTEMPTY && errno != EEXIST) fail(shown, "the results cannot be put in place", errno);
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) fail(shown, "the results cannot be put in place", errno);
  if (::rename(to.c_str(), aside.c_str()) != 0) fail(shown, "the earlier results cannot be moved", errno);
  if (::rename(from.c_str(), to.c_str()) == 0) return;
  const int reason = errno;
  if (::rename(aside.c_str(), to.c_str()) == 0) fail(shown, "the results cannot be put in place", reason);
  const fs::path kept = to.string() + "-" + random_digits();
  ::rename(aside.c_str(), kept.c_str());
  fail(shown, "other files have come to its place, and the earlier results are in " + kept.string(), reason);
}

// Undoes the first rename of an exchange after which a run was killed. After the second one, the new results
// have the name.
void put_back(const fs::path& earlier, const fs::path& target, const fs::path& shown) {
  if (::rename(earlier.c_str(), target.c_str()) == 0 || errno == ENOENT || is_result_folder(target)) return;
  throw Error(shown.string() + ": other files have taken the place of earlier results, which are in " +
              earlier.string() + "; allowed: move these results, or those files, to another place");
}

// The kernel has the same limit for all file systems but few.
void require_short(const fs::path& name, const std::string& prefix, const fs::path& shown) {
  const std::size_t bytes = name.string().size(), most = NAME_MAX - (prefix.size() - bytes) - kDrawnDigits;
  if (bytes > most)
    throw Error(shown.string() + ": the name of the folder has " + std::to_string(bytes) +
                " bytes; allowed: at most " + std::to_string(most));
}

// Refuses before the work a folder that no rename can replace. It may be of a lower layer of an overlay, such
// as of a container's image, or of another user in a sticky folder. This rename fails in any case, since
// `onto` holds a file.
void require_movable(const fs::path& target, const fs::path& onto, const fs::path& shown) {
  if (::rename(target.c_str(), onto.c_str()) == 0) {
    ::rename(onto.c_str(), target.c_str());
  } else if (errno == EXDEV || errno == EPERM) {
    throw Error(shown.string() + ": the system cannot replace this folder: " + std::strerror(errno) +
                "; allowed: another folder, or remove this one first");
  }
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& folder) : folder_(folder) {
  std::error_code error;
  if (fs::is_symlink(folder, error) && !fs::exists(folder, error))
    throw Error(folder.string() + ": a link to " + fs::read_symlink(folder).string() +
                ", which is missing; allowed: a folder, or a name that is free");
  target_ = fs::weakly_canonical(fs::absolute(folder), error);
  if (error == std::errc::filename_too_long)
    target_ = fs::absolute(folder).lexically_normal();
  else if (error)
    throw Error(folder.string() + ": " + error.message());
  if (!target_.has_filename()) target_ = target_.parent_path();
  if (!target_.has_filename()) throw Error("\"" + folder.string() + "\": the name of a folder is needed");
  const fs::path parent = target_.parent_path();
  const std::string prefix = "." + target_.filename().string() + kList + "-";
  require_short(target_.filename(), prefix, folder);

  const auto rescue = [&](const fs::path& left) { put_back(left / kEarlier, target_, folder); };
  const auto look = [&] { return remove_leftovers(parent, prefix, rescue); };
  if (!look().empty()) fail_in_use(folder);
  if (!remove_leftovers(target_, kTemporaryPrefix).empty()) fail_in_use(folder);  // of lacuna report
  const bool is_free = replaced_files(target_, folder).empty(), exists = fs::exists(target_);
  if (is_mount_point(target_))
    throw Error(folder.string() +
                ": is a mount point, which results cannot replace; allowed: a folder in it, such as " +
                (folder / "holes").string());
  if (exists && ::access(target_.c_str(), W_OK | X_OK) != 0)
    fail(folder, "cannot write to the folder", errno);
  fs::create_directories(parent, error);
  if (error) throw Error(parent.string() + ": cannot create the folder: " + error.message());

  temporary_.emplace(parent, prefix);
  if (!temporary_->is_locked())
    spdlog::warn("{}: its file system knows no locks; no other run may write there meanwhile",
                 folder.string());
  if (!fs::create_directory(staged(), error)) fail(staged(), "cannot be made", error.value());
  // Other users see that this process is at work.
  fs::permissions(temporary(), fs::status(staged()).permissions(), fs::perm_options::add, error);
  if (!is_free) require_movable(target_, temporary(), folder);
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
  replaced_files(target_, folder_);  // may have become others meanwhile
  exchange(staged(), target_, temporary() / kEarlier, folder_);
  sync_folder(target_.parent_path(), ::fsync);
  return written;
}

bool is_result_folder(const fs::path& folder) {
  return std::ranges::any_of(listed_files(folder),
                             [&](const std::string& name) { return is_regular(folder / name); });
}

std::vector<fs::path> copy_results(const fs::path& from, const fs::path& to) {
  const std::set<std::string> listed = listed_files(from);
  ResultFolder results(to);
  for (const std::string& name : files_in(from)) {
    const bool is_result = listed.empty() ? name != kList : listed.contains(name);
    if (!is_result || !is_regular(from / name)) continue;
    fs::create_directories((results.staged() / name).parent_path());
    fs::copy_file(from / name, results.staged() / name);
  }
  return results.commit();
}

void note_result(const fs::path& folder, const std::string& name) {
  const std::set<std::string> listed = listed_files(folder);
  if (listed.empty() || listed.contains(name)) return;
  const fs::path list = folder / kList;
  const Descriptor opened(::open(list.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  const std::string line = name + "\n";
  if (!opened.is_open() ||
      ::write(opened.number(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    fail(list, "cannot be written", errno);
}

}  // namespace lacuna::io
