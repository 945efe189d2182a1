// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test.hpp"

#include "tests/support/json.hpp"

#include <stdlib.h>

std::string Catch::StringMaker<nlohmann::json>::convert(const nlohmann::json& value) {
  return value.dump();
}

namespace lacuna::test {

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "lacuna test XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

std::string ScratchFolder::write(const std::string& name, std::string_view content) const {
  const fs::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << content;
  return file.string();
}

std::vector<std::string> ScratchFolder::names() const {
  return names_of(path_);
}

std::vector<std::string> names_of(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::size_t count_entries(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    count += entry.path().filename().string().starts_with('.') ? 0 : 1;
  return count;
}

fs::path temporary_of(const fs::path& results) {
  const std::string begin = "." + results.filename().string() + ".lacuna-";
  for (const auto& entry : fs::directory_iterator(results.parent_path()))
    if (entry.path().filename().string().starts_with(begin)) return entry.path();
  return {};
}

std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

nlohmann::json json_of(const std::string& text) {
  return nlohmann::json::parse(text);
}

nlohmann::json read_json(const fs::path& file) {
  return json_of(read_file(file));
}

}  // namespace lacuna::test
