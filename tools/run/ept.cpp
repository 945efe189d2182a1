// SPDX-License-Identifier: Apache-2.0
#include "tools/run/ept.hpp"

#include "engine/run/error.hpp"
#include "io/formats.hpp"
#include "tools/console/visible_text.hpp"

#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(file.string() + ": " + reason);
}

// Returns what is not an object if the file is none.
Json read_object(const fs::path& file) {
  std::ifstream in(file);
  return Json::parse(in, nullptr, false);
}

// Depth, x, y and z.
bool is_tile(std::string_view name) {
  return !name.empty() && name.find_first_not_of("0123456789-") == name.npos;
}

fs::path file_of(const fs::path& data, const std::string& tile) {
  return data / (tile + ".laz");
}

using Tiles = std::map<std::string, std::uint64_t>;  // points of each

// A tile of -1 points has a file of its own, which counts it and the tiles below it.
Tiles read_hierarchy(const fs::path& folder) {
  Tiles tiles;
  std::set<std::string> roots;
  std::vector<std::string> left = {"0-0-0-0"};
  while (!left.empty()) {
    const std::string root = left.back();
    left.pop_back();
    const fs::path file = folder / (root + ".json");
    const Json json = read_object(file);
    if (!json.is_object())
      fail(file, "is missing, or no JSON object; the hierarchy counts the points of tiles");
    if (!roots.insert(root).second) fail(file, "the hierarchy names this file more than once");
    for (const auto& [name, points] : json.items()) {
      if (!is_tile(name) || !(points.is_number_unsigned() || points == -1))
        fail(file, "\"" + visible(name) + "\": " + visible(points.dump()) +
                       " is not the number of points of a tile, or -1");
      if (points == -1) {
        left.push_back(name);
      } else if (!tiles.emplace(name, points.get<std::uint64_t>()).second) {
        fail(file, "the hierarchy counts tile " + name + " more than once");
      }
    }
  }
  return tiles;
}

void check_sum(const fs::path& ept, const Tiles& tiles) {
  const Json json = read_object(ept);
  const auto points = json.find("points");
  if (points == json.end() || !points->is_number_unsigned()) fail(ept, "has no number \"points\"");
  std::uint64_t sum = 0;
  for (const auto& [name, count] : tiles) sum += count;
  if (sum != *points)
    fail(ept,
         "counts " + points->dump() + " points, but the tiles of its hierarchy have " + std::to_string(sum));
}

void check_names(const fs::path& data, const Tiles& tiles) {
  std::vector<std::string> missing;
  for (const auto& [name, count] : tiles) {
    std::error_code error;
    if (count > 0 && !fs::exists(file_of(data, name), error)) missing.push_back(name);
  }
  if (!missing.empty())
    fail(file_of(data, missing[0]), "is missing; of the " + std::to_string(tiles.size()) +
                                        " tiles in the hierarchy, " + std::to_string(missing.size()) +
                                        " cannot be found");
  std::error_code error;
  for (fs::directory_iterator entry(data, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.extension() == ".laz" && !tiles.contains(file.stem().string()))
      fail(file, "is no tile of the hierarchy");
  }
}

void check_counts(const fs::path& data, const Tiles& tiles, const io::ReadOptions& options) {
  for (const auto& [name, count] : tiles) {
    if (count == 0) continue;
    const fs::path file = file_of(data, name);
    const std::uint64_t points = io::open_scan(file, options)->expected_rows().value_or(count);
    if (points != count)
      fail(file,
           "has " + std::to_string(points) + " points, but the hierarchy counts " + std::to_string(count));
  }
}

}  // namespace

fs::path find_ept(const fs::path& input) {
  std::error_code error;
  const fs::path file = fs::is_directory(input, error) ? input / "ept.json" : input;
  return file.filename() == "ept.json" && fs::is_regular_file(file, error) ? file : fs::path();
}

fs::path ept_data(const fs::path& ept) {
  const Json json = read_object(ept);
  const auto type = json.is_object() ? json.find("dataType") : json.end();
  if (type == json.end() || !type->is_string()) fail(ept, "has no \"dataType\", which each ept.json has");
  if (*type != "laszip")
    fail(ept, "its points are of the type \"" + visible(type->get<std::string>()) + "\"; allowed: laszip");
  return ept.parent_path() / "ept-data";
}

void check_ept(const fs::path& ept, const io::ReadOptions& options) {
  const fs::path data = ept.parent_path() / "ept-data";
  const Tiles tiles = read_hierarchy(ept.parent_path() / "ept-hierarchy");
  check_sum(ept, tiles);
  check_names(data, tiles);
  check_counts(data, tiles, options);
}

}  // namespace lacuna::tools
