// SPDX-License-Identifier: Apache-2.0
#include "io/read/ept.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/json_file.hpp"
#include "io/read/formats.hpp"

#include <cstdint>
#include <string>
#include <system_error>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(file.string() + ": " + reason);
}

// Returns the object in ept.json.
Json read_head(const fs::path& ept) {
  Json json = read_json(ept, "an ept.json");
  if (!json.is_object()) fail(ept, "is no JSON object; an ept.json is needed");
  return json;
}

fs::path folder_of_tiles(const fs::path& ept) {
  return ept.parent_path() / "ept-data";
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
  return folder_of_tiles(ept);
}

void check_ept(const fs::path& ept, const ReadOptions& options) {
  const Json json = read_head(ept);
  const auto points = json.find("points");
  if (points == json.end() || !points->is_number_unsigned()) fail(ept, "has no number \"points\"");
  std::uint64_t sum = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder_of_tiles(ept), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".laz")
      sum += open_scan(entry->path(), options)->expected_rows().value_or(0);
  }
  if (error) fail(folder_of_tiles(ept), "cannot be read: " + error.message());
  if (sum != *points)
    fail(ept, "counts " + points->dump() + " points, but its tiles have " + std::to_string(sum) +
                  "; tiles are missing, or are of another scan");
}

}  // namespace lacuna::io
