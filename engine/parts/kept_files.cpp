// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/kept_files.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <regex>
#include <system_error>

namespace lacuna {

namespace fs = std::filesystem;

bool is_kept_name(const fs::path& file) {
  static const std::regex names(
      "(run|plan|(survey|tiles|bucket|level|evaluate|loops)(-[0-9]+)?-[0-9a-f]+(\\.points|\\.normals)?)"
      "\\.lacuna(\\.[0-9a-f]{16})?(\\.partial)?");
  return std::regex_match(file.filename().string(), names);
}

bool is_kept_folder(const fs::path& folder) {
  return !kept_files(folder).empty();
}

fs::path part_file(const fs::path& folder, const std::string& step, const std::string& task) {
  return folder / (step + "-" + task + ".lacuna");
}

std::vector<fs::path> kept_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;  // a folder that is missing keeps nothing
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (fs::is_regular_file(entry.symlink_status()) && is_kept_name(entry.path()))
      files.push_back(entry.path());
  }
  if (!PartReader::is_part(folder / kRunPart) && std::ranges::none_of(files, PartReader::is_part))
    files.clear();
  std::sort(files.begin(), files.end());
  return files;
}

bool is_of_step(const fs::path& file, const std::string& step) {
  return file.filename().string().starts_with(step + "-");
}

void remove_kept(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot be removed: " + error.message());
}

}  // namespace lacuna
