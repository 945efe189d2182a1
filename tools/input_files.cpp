#include "tools/input_files.hpp"

#include "engine/run/error.hpp"
#include "io/input_file.hpp"
#include "io/scan_reader.hpp"
#include "tools/visible_text.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include <spdlog/spdlog.h>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

bool is_readable(const fs::path& file, const ReadOptions& options) {
  try {
    open_scan(file, options);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// Text may be anything, so it must also be readable. A file of another format that is broken is an error,
// later.
bool is_scan(const fs::path& file, const ReadOptions& options) {
  const Recognised recognised = recognise(file);
  return recognised == Recognised::kYes || (recognised == Recognised::kAsText && is_readable(file, options));
}

void add_folder(const fs::path& folder, const ReadOptions& options, std::vector<fs::path>& files) {
  std::vector<fs::path> inside;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(error) && !entry->path().filename().string().starts_with('.'))
      inside.push_back(entry->path());
  }
  if (error) throw Error(folder.string() + ": the folder cannot be read: " + error.message());
  std::sort(inside.begin(), inside.end());
  const std::size_t before = files.size();
  for (const fs::path& file : inside) {
    if (is_scan(file, options)) {
      files.push_back(file);
    } else {
      spdlog::warn("{}: passed over, since it is no scan", visible(file.string()));
    }
  }
  if (files.size() == before) throw Error(folder.string() + ": no scan file in this folder");
}

void add_list(const fs::path& list, std::vector<fs::path>& files) {
  InputFile in(list);
  const std::size_t before = files.size();
  while (const auto line = in.next_line()) {
    std::string name(*line);
    if (name.ends_with('\r')) name.pop_back();
    if (name.empty() || name.starts_with('#')) continue;
    files.push_back(list.parent_path() / name);
  }
  if (files.size() == before) in.fail("the list names no file");
}

}  // namespace

std::vector<fs::path> expand_inputs(const std::vector<fs::path>& given, const ReadOptions& options) {
  std::vector<fs::path> files;
  for (const fs::path& input : given) {
    std::error_code error;  // what is missing is an error later, when it is opened
    if (input.string().starts_with('@') && !fs::exists(input, error)) {
      add_list(input.string().substr(1), files);
    } else if (fs::is_directory(input, error)) {
      add_folder(input, options, files);
    } else {
      files.push_back(input);
    }
  }
  return files;
}

}  // namespace lacuna
