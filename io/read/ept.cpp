// SPDX-License-Identifier: Apache-2.0
#include "io/read/ept.hpp"

#include "io/read/files/input_file.hpp"
#include "io/read/files/json_file.hpp"
#include "io/read/files/number.hpp"
#include "io/read/formats.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

fs::path find_ept(const fs::path& input) {
  std::error_code error;
  const fs::path file = fs::is_directory(input, error) ? input / "ept.json" : input;
  return file.filename() == "ept.json" && fs::is_regular_file(file, error) ? file : fs::path();
}

fs::path ept_data(const fs::path& ept) {
  const Json json = read_head(ept);
  const auto type = json.find("dataType");
  if (type == json.end() || !type->is_string()) fail(ept, "has no \"dataType\", which each ept.json has");
  if (*type != "laszip")
    fail(ept, "its points are of the type " + in_quotes(type->get<std::string>()) + "; allowed: laszip");
  return ept.parent_path() / "ept-data";
}

void check_ept(const fs::path& ept, const ReadOptions& options) {
  const fs::path data = ept.parent_path() / "ept-data";
  const Hierarchy hierarchy(ept.parent_path() / "ept-hierarchy", options.memory);
  check_sum(ept, hierarchy.tiles());
  check_names(data, hierarchy);
  check_counts(data, hierarchy.tiles(), options);
}

}  // namespace lacuna::io
