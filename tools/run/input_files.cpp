// SPDX-License-Identifier: Apache-2.0
#include "tools/run/input_files.hpp"

#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/json_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/files/result_folder.hpp"
#include "io/read/formats.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
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

// Entwine's point tiles (https://entwine.io/en/latest/entwine-point-tile.html): a folder of LAZ files.

// A hierarchy that does not fit in memory. Its tiles cannot be read without it.
struct TooManyTiles : Error {
  using Error::Error;
};

constexpr const char* kEnding = ".laz";

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(file.string() + ": " + reason);
}

// Returns the object in ept.json.
Json read_head(const fs::path& ept) {
  Json json = read_json(ept, "an ept.json");
  if (!json.is_object()) fail(ept, "is no JSON object; an ept.json is needed");
  return json;
}

// Depth, x, y and z, which are the name of a tile: "2-0-3-1".
using Place = std::array<std::uint32_t, 4>;

std::string name_of(const Place& place) {
  std::string name = std::to_string(place[0]);
  for (std::size_t i = 1; i < place.size(); ++i) name += "-" + std::to_string(place[i]);
  return name;
}

std::optional<Place> parse_name(std::string_view name) {
  Place place{};
  std::string_view left = name;
  for (std::uint32_t& number : place) {
    const std::string_view digits = left.substr(0, left.find('-'));
    if (!parse_number(digits, number)) return std::nullopt;
    left.remove_prefix(std::min(digits.size() + 1, left.size()));
  }
  return name_of(place) == name ? std::optional(place) : std::nullopt;
}

fs::path file_of(const fs::path& folder, const Place& place, const char* ending) {
  return folder / (name_of(place) + ending);
}

struct Tile {
  Place place;
  std::uint64_t points;
};

// The tiles of all files of a hierarchy. A tile of -1 points has a file of its own, which counts it and the
// tiles below it.
class Hierarchy {
 public:
  Hierarchy(const fs::path& folder, std::uint64_t memory) : folder_(folder), most_(memory / kBytesOfTile) {
    while (!left_.empty()) {
      const Place root = left_.back();
      left_.pop_back();
      read(file_of(folder, root, ".json"), root);
    }
    std::ranges::sort(tiles_, {}, &Tile::place);
    const auto twice = std::ranges::adjacent_find(tiles_, {}, &Tile::place);
    if (twice != tiles_.end())
      fail(folder_, "the hierarchy counts tile " + name_of(twice->place) + " more than once");
  }

  std::span<const Tile> tiles() const { return tiles_; }
  bool has(const Place& place) const { return std::ranges::binary_search(tiles_, place, {}, &Tile::place); }

 private:
  static constexpr std::uint64_t kBytesOfTile = 4 * sizeof(Tile);  // of a list that grows

  void read(const fs::path& file, const Place& root) {
    if (!roots_.insert(root).second) fail(file, "the hierarchy names this file more than once");
    std::string name;
    const auto take = [&](int depth, Json::parse_event_t event, const Json& parsed) {
      using Event = Json::parse_event_t;
      if (event == Event::key) name = parsed.get_ref<const std::string&>();
      if (depth == 0) return event != Event::array_start;
      if (event != Event::key) add(file, name, parsed);
      return false;
    };
    if (!read_json(file, "a hierarchy of point tiles", take).is_object())
      fail(file, "is no JSON object; a hierarchy of point tiles is needed");
  }

  void add(const fs::path& file, std::string_view name, const Json& points) {
    const std::optional<Place> place = parse_name(name);
    if (!place || !(points.is_number_unsigned() || points == -1))
      fail(file, in_quotes(name) + ": " + (points.is_primitive() ? in_quotes(points.dump()) : "a list") +
                     " is not the number of points of a tile, or -1");
    if (points == -1) {
      left_.push_back(*place);
    } else {
      tiles_.push_back({*place, points.get<std::uint64_t>()});
    }
    if (tiles_.size() + left_.size() + roots_.size() > most_)
      throw TooManyTiles(folder_.string() + ": has more tiles than the " + std::to_string(most_) +
                         " that fit in the memory limit; allowed: a higher limit");
  }

  fs::path folder_;
  std::uint64_t most_;
  std::vector<Tile> tiles_;  // ascending
  std::vector<Place> left_ = {{0, 0, 0, 0}};
  std::set<Place> roots_;
};

void check_sum(const fs::path& ept, std::span<const Tile> tiles) {
  const Json json = read_head(ept);
  const auto points = json.find("points");
  if (points == json.end() || !points->is_number_unsigned()) fail(ept, "has no number \"points\"");
  std::uint64_t sum = 0;
  for (const Tile& tile : tiles) sum += tile.points;
  if (sum != *points)
    fail(ept,
         "counts " + points->dump() + " points, but the tiles of its hierarchy have " + std::to_string(sum));
}

void check_names(const fs::path& data, const Hierarchy& hierarchy) {
  const std::span<const Tile> tiles = hierarchy.tiles();
  fs::path first;
  std::size_t missing = 0;
  for (const Tile& tile : tiles) {
    std::error_code error;
    const fs::path file = file_of(data, tile.place, kEnding);
    if (tile.points == 0 || fs::exists(file, error)) continue;
    if (missing++ == 0) first = file;
  }
  if (missing > 0)
    fail(first, "is missing; of the " + std::to_string(tiles.size()) + " tiles in the hierarchy, " +
                    std::to_string(missing) + " cannot be found");
  std::error_code error;
  for (fs::directory_iterator entry(data, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.extension() != kEnding) continue;
    const std::optional<Place> place = parse_name(file.stem().string());
    if (!place || !hierarchy.has(*place)) fail(file, "is no tile of the hierarchy");
  }
}

void check_counts(const fs::path& data, std::span<const Tile> tiles, const ReadOptions& options) {
  for (const auto& [place, count] : tiles) {
    if (count == 0) continue;
    const fs::path file = file_of(data, place, kEnding);
    const std::uint64_t points = open_scan(file, options)->expected_rows().value_or(count);
    if (points != count)
      fail(file,
           "has " + std::to_string(points) + " points, but the hierarchy counts " + std::to_string(count));
  }
}

// Returns the ept.json that a name stands for: itself, or the one in a folder. Empty if there is none.
fs::path find_ept(const fs::path& input) {
  std::error_code error;
  const fs::path file = fs::is_directory(input, error) ? input / "ept.json" : input;
  return file.filename() == "ept.json" && fs::is_regular_file(file, error) ? file : fs::path();
}

// Returns the folder of the tiles. Throws `Error` if they are no LAZ files.
fs::path ept_data(const fs::path& ept) {
  const Json json = read_head(ept);
  const auto type = json.find("dataType");
  if (type == json.end() || !type->is_string()) fail(ept, "has no \"dataType\", which each ept.json has");
  if (*type != "laszip")
    fail(ept, "its points are of the type " + in_quotes(type->get<std::string>()) + "; allowed: laszip");
  return ept.parent_path() / "ept-data";
}

// Throws `Error` unless the tiles are those of the hierarchy, which may have several files. Their points must
// add up to the number in ept.json, and a tile must have as many as the hierarchy counts. The function opens
// each tile once. Memory: about 100 bytes for each tile of the hierarchy, within that of the options.
void check_ept(const fs::path& ept, const ReadOptions& options) {
  const fs::path data = ept.parent_path() / "ept-data";
  const Hierarchy hierarchy(ept.parent_path() / "ept-hierarchy", options.memory);
  check_sum(ept, hierarchy.tiles());
  check_names(data, hierarchy);
  check_counts(data, hierarchy.tiles(), options);
}

void add_ept(const fs::path& ept, const ReadOptions& options, const InputConfig& config,
             std::vector<ScanInput>& files) {
  const fs::path data = ept_data(ept);
  try {
    check_ept(ept, options);
  } catch (const TooManyTiles&) {
    throw;
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

Option add_scans(const Command& command, std::vector<fs::path>& scans) {
  return command
      .add_option("SCAN", scans,
                  "Scan files, folders of them, or @LIST of their names; several are one registered scan")
      .type("SCAN");
}

ReadOptions read_options(const FilesConfig& config) {
  return io::read_options(config.input, Memory::share(config.run.memory_limit).reading);
}

}  // namespace lacuna::tools
