// SPDX-License-Identifier: Apache-2.0
#include "tests/support/open_files.hpp"

#include "tests/support/test.hpp"

#include <unistd.h>

namespace lacuna::test {
namespace {

struct OpenFile {
  fs::path entry;  // leads to the file though it has no name
  std::uint64_t size;
};

std::optional<OpenFile> find_open(pid_t process, const std::string& name) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", error)) {
    const std::string target = fs::read_symlink(entry.path(), error).string();
    if (fs::path(target.substr(0, target.find(" (deleted)"))).filename() != name) continue;
    const std::uintmax_t size = fs::file_size(entry.path(), error);
    if (!error && size > 0) return OpenFile{entry.path(), size};
  }
  return std::nullopt;
}

}  // namespace

bool has_open(pid_t process, const std::string& name) {
  return find_open(process, name).has_value();
}

bool cut_open_file(pid_t process, const std::string& name) {
  const std::optional<OpenFile> file = find_open(process, name);
  return file && ::truncate(file->entry.c_str(), static_cast<off_t>(file->size / 2)) == 0;
}

}  // namespace lacuna::test
