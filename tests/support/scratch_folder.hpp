// SPDX-License-Identifier: Apache-2.0
// A folder of its own for a test, and files in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::test {

// Gone at the end, with all that is in it. Its name has spaces.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, std::string_view content) const;  // the file's path
  std::vector<std::string> names() const;                                      // of what is in it, sorted

 private:
  std::filesystem::path path_;
};

std::vector<std::string> names_of(const std::filesystem::path& folder);  // of what is in it, sorted

// Without hidden ones, which begin with a dot.
std::size_t count_entries(const std::filesystem::path& folder);

// Returns the temporary folder of the run that makes these results. It is empty where there is none.
std::filesystem::path temporary_of(const std::filesystem::path& results);

std::string read_file(const std::filesystem::path& file);

}  // namespace lacuna::test
