// SPDX-License-Identifier: Apache-2.0
#include "tools/run/config_files.hpp"

#include "engine/run/error.hpp"
#include "engine/run/words.hpp"

#include <set>
#include <string_view>
#include <system_error>
#include <vector>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> config_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path folder = program.parent_path();
  std::vector<fs::path> folders = {folder.parent_path() / "share/lacuna/configs",
                                   folder / "share/lacuna/configs"};
  if (fs::exists(folder / "CMakeCache.txt", error)) folders.push_back(folder.parent_path() / "configs");
  return folders;
}

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;  // a folder that is missing has no config
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    }
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw Error("--config " + name + ": no file and no installed config has this name" +
              suggestion(name, known) + "; allowed: a TOML file" +
              (known.empty() ? "; no config is installed" : ", or one of these: " + listed(known)));
}

}  // namespace

fs::path find_config(const std::string& given) {
  std::error_code error;
  const bool is_file = given.find('/') != given.npos || given.ends_with(".toml") || fs::exists(given, error);
  if (is_file) return given;
  const std::vector<fs::path> folders = config_folders();
  for (const fs::path& folder : folders) {
    const fs::path file = folder / (given + ".toml");
    if (fs::exists(file, error)) return file;
  }
  fail_unknown(given, folders);
}

}  // namespace lacuna::tools
