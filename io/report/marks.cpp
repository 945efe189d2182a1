// SPDX-License-Identifier: Apache-2.0
#include "io/report/marks.hpp"

#include "engine/run/error.hpp"
#include "io/loops/json.hpp"

#include <algorithm>

namespace lacuna::io {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostId = 1ull << 53;  // beyond it, numbers of a page lose digits

// Reads values of one entry. Errors name the file and the place in it.
class Entry {
 public:
  Entry(const fs::path& file, std::size_t index, const Json& json)
      : place_(file.string() + ": marks[" + std::to_string(index) + "]"), json_(json) {
    if (!json.is_object()) fail("", json, "an object is allowed");
  }

  std::uint64_t id() const {
    const Json& value = at("id");
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= kMostId)
      fail(".id", value, "a whole number from 0 is allowed");
    return value.get<std::uint64_t>();
  }

  LoopKind kind() const {
    const Json& value = at("kind");
    for (const LoopKind kind : {LoopKind::kHole, LoopKind::kOuter})
      if (value == name_of(kind)) return kind;
    fail(".kind", value, "hole and outer are allowed");
  }

  Eigen::Vector3d centroid() const {
    const Json& value = at("centroid");
    const auto is_number = [](const Json& number) { return number.is_number(); };
    if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), is_number))
      fail(".centroid", value, "three numbers are allowed");
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }

  double diameter() const {
    const Json& value = at("diameter");
    if (!value.is_number() || !(value.get<double>() > 0))
      fail(".diameter", value, "a number above 0 is allowed");
    return value.get<double>();
  }

  std::string mark() const {
    const Json& value = at("mark");
    for (const std::string_view name : kMarkNames)
      if (value == name) return std::string(name);
    fail(".mark", value, "none, real, ignore, scan again and done are allowed");
  }

  std::string note() const {
    const Json& value = at("note");
    if (!value.is_string()) fail(".note", value, "a text is allowed");
    return value.get<std::string>();
  }

 private:
  const Json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end())
      throw Error(place_ + ": the key " + key +
                  " is missing; id, kind, centroid, diameter, mark and note are needed");
    return *found;
  }

  [[noreturn]] void fail(const char* key, const Json& value, const char* allowed) const {
    constexpr std::size_t kMostShown = 60;  // bytes
    std::string text = print(value, -1);
    if (text.size() > kMostShown) text = text.substr(0, kMostShown) + "...";
    throw Error(place_ + key + ": " + text + " is not allowed; " + allowed);
  }

  std::string place_;
  const Json& json_;
};

}  // namespace

std::vector<LoopMark> read_marks(const fs::path& file) {
  Json json;
  try {
    json = read_json(file, {}, "a file of marks, as the report saves it,");
  } catch (const Json::out_of_range&) {  // 1e999
    throw Error(file.string() + ": a number is too large; allowed: numbers that fit in 64 bits");
  }
  if (!json.is_object() || !json.contains("schema") || json.at("schema") != kMarksSchema)
    throw Error(file.string() + ": is not a file of marks; \"schema\": \"" + std::string(kMarksSchema) +
                "\" is needed");
  if (!json.contains("marks") || !json.at("marks").is_array())
    throw Error(file.string() + ": the key marks is missing or no list; a list is needed");
  std::vector<LoopMark> marks;
  for (const Json& value : json.at("marks")) {
    const Entry entry(file, marks.size(), value);
    marks.push_back({.id = entry.id(),
                     .kind = entry.kind(),
                     .centroid = entry.centroid(),
                     .diameter = entry.diameter(),
                     .mark = entry.mark(),
                     .note = entry.note()});
  }
  return marks;
}

}  // namespace lacuna::io
