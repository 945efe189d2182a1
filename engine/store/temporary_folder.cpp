// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_folder.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>

namespace lacuna {

namespace fs = std::filesystem;

namespace {

std::recursive_mutex mutex;  // of the list, and of what must not be half done when a signal ends the process
std::vector<fs::path> folders;  // absolute

// Other threads may still add files, so removing takes several rounds.
void remove_persistently(const fs::path& folder) {
  for (int round = 0; round < 100; ++round) {
    std::error_code error;
    fs::remove_all(folder, error);
    if (!error && !fs::exists(folder, error)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  std::string name = (parent / (prefix + "XXXXXX")).string();
  const std::lock_guard lock(mutex);  // a signal finds the folder in the list, or not made yet
  if (!mkdtemp(name.data())) {
    throw Error(parent.string() + ": cannot make a temporary folder: " + std::strerror(errno));
  }
  folder_ = name;
  folders.push_back(fs::absolute(folder_));
}

TemporaryFolder::TemporaryFolder(const fs::path& folder) : folder_(folder) {
  const std::lock_guard lock(mutex);
  folders.push_back(fs::absolute(folder_));
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    fs::remove_all(entry.path(), error);
    if (error) throw Error(entry.path().string() + ": cannot be removed: " + error.message());
  }
}

TemporaryFolder::~TemporaryFolder() {
  if (is_kept_) return;
  std::error_code error;
  fs::remove_all(folder_, error);
  if (!error) keep();  // else it is a remaining folder
}

void TemporaryFolder::keep() {
  const std::lock_guard lock(mutex);
  std::erase(folders, fs::absolute(folder_));
  is_kept_ = true;
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
  for (const fs::path& folder : folders) {
    std::error_code error;
    fs::remove_all(folder, error);
    if (error) remaining.push_back({folder, error.message()});
  }
  return remaining;
}

void remove_temporary_folders() {
  mutex.lock();  // and never unlocked
  for (const fs::path& folder : folders) remove_persistently(folder);
}

RemovalPause::RemovalPause() : lock_(mutex) {}

std::vector<fs::path> find_folders(const fs::path& parent, const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code error;  // a folder that cannot be read has none
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    if (entry.is_directory(error) && entry.path().filename().string().starts_with(prefix))
      found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace lacuna
