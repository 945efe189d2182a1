// SPDX-License-Identifier: Apache-2.0
#include "tools/run/input_files.hpp"

#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/read/ept.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/formats.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPoseBlanks = " \t,";

// What a folder holds, each sorted by name.
struct Folder {
  std::vector<fs::path> binary, texts, others, folders;
};

bool is_hidden(const fs::path& file) {
  return file.filename().string().starts_with('.');
}

Folder list_folder(const fs::path& folder) {
  std::vector<fs::path> inside;
  std::error_code error;
  Folder found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    if (is_hidden(entry->path())) continue;
    if (entry->is_regular_file(unknown)) inside.push_back(entry->path());
    if (entry->is_directory(unknown)) found.folders.push_back(entry->path());
  }
  if (error) throw Error(folder.string() + ": the folder cannot be read: " + error.message());
  std::sort(inside.begin(), inside.end());
  std::sort(found.folders.begin(), found.folders.end());
  for (const fs::path& file : inside) {
    const std::optional<Format> format = find_format(file);
    (!format ? found.others : format == Format::kText ? found.texts : found.binary).push_back(file);
  }
  return found;
}

// Returns the first names, and how many more there are.
std::string print_names(const std::vector<fs::path>& files) {
  constexpr std::size_t kMost = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, files.size()); ++i)
    text += (i == 0 ? "" : ", ") + visible(files[i].filename().string());
  return files.size() > kMost ? text + " and " + std::to_string(files.size() - kMost) + " more" : text;
}

void warn_of_unread(const fs::path& folder, const Folder& unread) {
  std::string text;
  const auto add = [&](const std::vector<fs::path>& files, const std::string& why) {
    if (!files.empty()) text += (text.empty() ? "" : "; ") + print_names(files) + " (" + why + ")";
  };
  add(unread.others, "no scan");
  add(unread.texts, "text among binary scans; it takes part if it is named");
  add(unread.folders, "a folder; --recursive reads it");
  if (!text.empty()) spdlog::warn("{}: not read: {}", visible(folder.string()), text);
}

void add_files(const fs::path& folder, const ReadOptions& options, const InputConfig& config,
               std::vector<ScanInput>& files) {
  if (is_result_folder(folder))
    return spdlog::warn("{}: not read: results of lacuna", visible(folder.string()));
  Folder found = list_folder(folder);
  files.insert(files.end(), found.binary.begin(), found.binary.end());
  // Text may be anything, such as a readme or control points. Alone in a folder, it must be readable.
  if (found.binary.empty()) {
    for (const fs::path& file : std::exchange(found.texts, {})) {
      try {
        open_scan(file, options);
        files.emplace_back(file);
      } catch (const Error& error) {
        spdlog::warn("skipped: {}", visible(error.what()));
      }
    }
  }
  const std::vector<fs::path> folders =
      config.recursive ? std::exchange(found.folders, {}) : std::vector<fs::path>();
  warn_of_unread(folder, found);
  for (const fs::path& deeper : folders) {
    if (!fs::is_symlink(deeper)) add_files(deeper, options, config, files);  // a link may lead back
  }
}

void add_folder(const fs::path& folder, const ReadOptions& options, const InputConfig& config,
                std::vector<ScanInput>& files) {
  const std::size_t before = files.size();
  add_files(folder, options, config, files);
  if (files.size() == before) throw Error(folder.string() + ": no scan file in this folder");
}

// Returns why a file cannot be read to its end; empty if it can.
std::string damage_of(const ScanInput& input, const ReadOptions& options) {
  constexpr std::size_t kRows = 4096;
  try {
    const auto reader = open_scan(input.name, options);
    RowBatch rows;
    while (reader->next(rows, kRows)) {
    }
    return {};
  } catch (const Error& error) {
    return visible(error.what());
  }
}

void leave_out_damaged(const ReadOptions& options, std::vector<ScanInput>& files) {
  std::string first;
  std::erase_if(files, [&](const ScanInput& input) {
    const std::string reason = damage_of(input, options);
    if (reason.empty()) return false;
    spdlog::warn("skipped: {}", reason);
    if (first.empty()) first = reason;
    return true;
  });
  if (files.empty()) throw Error(first + "; no other file is left");
}

void add_ept(const fs::path& ept, const ReadOptions& options, const InputConfig& config,
             std::vector<ScanInput>& files) {
  const fs::path data = ept_data(ept);
  try {
    check_ept(ept, options);
  } catch (const Error& error) {
    const std::string reason = visible(error.what());
    if (!config.skip_damaged) throw Error(reason + "; --skip-damaged reads the tiles that are there");
    spdlog::warn("{}; the tiles that are there are read", reason);
  }
  add_folder(data, options, config, files);
}

// Returns what stands behind `pose=`: the numbers, the file that has them, or what the scan file itself says.
Pose find_pose(const fs::path& folder, std::string_view text, const fs::path& scan,
               const ReadOptions& options) {
  double number = 0;
  const std::string_view first = text.substr(0, text.find_first_of(kPoseBlanks));
  if (first == "viewpoint") {
    const std::optional<Pose> viewpoint = open_scan(scan, options)->viewpoint();
    if (!viewpoint)
      throw Error("pose=viewpoint: " + scan.string() +
                  " has no VIEWPOINT, as PCD has; allowed are the numbers of a pose, or a file of them");
    return *viewpoint;
  }
  return parse_number(first, number) ? parse_pose(text) : read_pose(folder / text);
}

// A line of a list: a file name, and what may follow it.
ScanInput parse_entry(const fs::path& folder, std::string_view line, const ReadOptions& options) {
  constexpr std::string_view kPose = "pose=";
  const std::size_t at = line.rfind(kPose);
  const bool has_pose = at != line.npos && at > 0 && kPoseBlanks.find(line[at - 1]) != kPoseBlanks.npos;
  if (!has_pose) return folder / line;
  const fs::path scan = folder / line.substr(0, line.find_last_not_of(kPoseBlanks, at - 1) + 1);
  return {scan, find_pose(folder, line.substr(at + kPose.size()), scan, options)};
}

void add_list(const fs::path& list, const ReadOptions& options, std::vector<ScanInput>& files) {
  InputFile in(list);
  const std::size_t before = files.size();
  if (in.peek(3) == "\xef\xbb\xbf") in.skip(3);  // byte order mark of UTF-8
  while (const auto line = in.next_line()) {
    std::string name(*line);
    if (name.ends_with('\r')) name.pop_back();
    if (name.empty() || name.starts_with('#')) continue;
    if (const std::size_t end = name.find('"', 1); name.front() == '"' && end != name.npos)
      name = name.substr(1, end - 1) + name.substr(end + 1);
    try {
      files.push_back(parse_entry(list.parent_path(), name, options));
    } catch (const Error& error) {
      in.fail_at_line(in.line(), error.what());
    }
  }
  if (files.size() == before) in.fail("the list names no file");
}

}  // namespace

std::vector<ScanInput> expand_inputs(const std::vector<fs::path>& given, const FilesConfig& all) {
  const InputConfig& config = all.input;
  const ReadOptions options = read_options(all);
  std::vector<ScanInput> files;
  for (const fs::path& input : given) {
    std::error_code error;  // what is missing is an error later, when it is opened
    if (input.empty()) throw Error("a scan without a name; allowed: files, folders and @LIST");
    if (input.string().find_first_of("*?") != std::string::npos && !fs::exists(input, error))
      throw Error(input.string() +
                  ": no file of this name; a pattern works without quotes, where it fits a file");
    if (input == "-") {
      throw Error(
          "-: standard input is not read, because a scan is read more than once; save it in a file first, "
          "and name "
          "that (./- for a file of this name)");
    }
    if (input.string().starts_with('@') && !fs::exists(input, error)) {
      add_list(input.string().substr(1), options, files);
    } else if (const fs::path ept = find_ept(input); !ept.empty()) {
      add_ept(ept, options, config, files);
    } else if (fs::is_directory(input, error)) {
      add_folder(input, options, config, files);
    } else {
      files.emplace_back(input);
    }
  }
  if (config.skip_damaged) leave_out_damaged(options, files);
  return files;
}

ReadOptions read_options(const FilesConfig& config) {
  return io::read_options(config.input, Memory::share(config.run.memory_limit).reading);
}

}  // namespace lacuna::tools
