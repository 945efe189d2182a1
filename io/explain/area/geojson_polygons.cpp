// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/explain/area/area_polygons.hpp"
#include "io/read/files/input_file.hpp"
#include "io/read/files/json_file.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

using Event = Json::parse_event_t;

constexpr std::string_view kNeeded = "GeoJSON with polygons";
constexpr int kNowhere = std::numeric_limits<int>::max();  // deeper than all

std::string type_of(const Json& object) {
  const auto type = object.find("type");
  return type != object.end() && type->is_string() ? type->get<std::string>() : "";
}

// Takes the parts of a file as they are read, and keeps its head alone.
class Features {
 public:
  explicit Features(HeldPolygons& to) : to_(to) {}

  bool keep(int depth, Event event, const Json& parsed) {
    if (depth < foreign_ || (depth == foreign_ && event == Event::key)) foreign_ = kNowhere;
    if (foreign_ != kNowhere) return false;
    if (event == Event::key) return begin_member(depth, parsed.get_ref<const std::string&>());
    if (is_coordinates_ && depth >= geometry_) return keep_coordinates(depth - geometry_, event, parsed);
    if (event != Event::object_end || is_crs_) return true;
    if (depth + 1 == geometry_) end_geometry(type_of(parsed));
    return depth == 0;
  }

 private:
  bool begin_member(int depth, std::string_view name) {
    constexpr std::array<std::string_view, 5> kMembers = {"type", "features", "geometry", "geometries",
                                                          "coordinates"};
    if (depth == 1) is_crs_ = name == "crs";
    is_coordinates_ = name == "coordinates" && !is_crs_;
    if (is_coordinates_) geometry_ = depth;
    if (is_crs_ || std::ranges::find(kMembers, name) != kMembers.end()) return true;
    foreign_ = depth;
    return false;
  }

  // A corner is a list of numbers, a ring one of corners, a polygon one of rings.
  bool keep_coordinates(int level, Event event, const Json& parsed) {
    constexpr std::size_t kPlane = 2;
    if (event == Event::object_start || (event == Event::value && !parsed.is_number()))
      fail("has a corner that is no list of numbers");
    if (event == Event::value) return numbers_++ < kPlane;
    if (event == Event::array_end && numbers_ > 0) {
      if (numbers_ < kPlane) fail("has a corner of less than two numbers");
      add_corner(level, {parsed.at(0).get<double>(), parsed.at(1).get<double>()});
    } else if (event == Event::array_end && level + 1 == corner_level_) {
      add_ring(std::exchange(ring_, {}), polygon_);
    } else if (event == Event::array_end && level + 2 == corner_level_) {
      polygons_.push_back(std::exchange(polygon_, {}));
    }
    numbers_ = 0;
    return event == Event::array_start || level == 0;
  }

  void add_corner(int level, const Eigen::Vector2d& corner) {
    if (corner_level_ == kNowhere) corner_level_ = level;
    if (level != corner_level_) fail("has coordinates that are nested unevenly");
    ring_.push_back(corner);
    check_corners(to_, ++corners_);
  }

  void end_geometry(std::string_view type) {
    const int levels = type == "Polygon" ? 2 : type == "MultiPolygon" ? 3 : kNowhere;
    if (levels != kNowhere && corner_level_ != kNowhere && corner_level_ != levels)
      fail("has a " + std::string(type) + " whose coordinates are nested otherwise");
    for (PlanPolygon& polygon : std::exchange(polygons_, {})) {
      if (levels != kNowhere && !polygon.empty()) take_polygon(std::move(polygon), to_);
    }
    ring_.clear();
    polygon_.clear();
    corners_ = 0;
    corner_level_ = geometry_ = kNowhere;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(to_.file + ": " + reason + "; " + std::string(kNeeded) + " is needed");
  }

  HeldPolygons& to_;
  int foreign_ = kNowhere;                        // depth of a member that is not of GeoJSON
  int geometry_ = kNowhere;                       // depth of the members of an object with coordinates
  bool is_crs_ = false, is_coordinates_ = false;  // whether the member is one
  // The geometry that is read; its type need not be known yet.
  int corner_level_ = kNowhere;
  std::size_t numbers_ = 0;  // of the corner
  std::uint64_t corners_ = 0;
  Ring2 ring_;
  PlanPolygon polygon_;
  std::vector<PlanPolygon> polygons_;
};

// Returns the system of the file: a name, as "urn:ogc:def:crs:EPSG::25832". Null says that there is none.
std::string crs_of(const Json& root, const std::string& file) {
  const auto crs = root.find("crs");
  if (crs == root.end()) return "EPSG:4326";
  if (crs->is_null()) return "";
  const auto name = Json::json_pointer("/properties/name");
  if (!crs->is_object() || !crs->contains(name) || !crs->at(name).is_string())
    throw Error(file + ": its member crs has no name of a system, such as urn:ogc:def:crs:EPSG::25832");
  return crs->at(name).get<std::string>();
}

}  // namespace

bool looks_like_geojson(const std::filesystem::path& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  InputFile in(file, 4096);
  std::string_view start = in.peek(4096);
  if (start.starts_with(kByteOrderMark)) start.remove_prefix(kByteOrderMark.size());
  const std::size_t first = start.find_first_not_of(kBlanks);
  return first != start.npos && start[first] == '{';
}

void read_geojson_polygons(HeldPolygons& polygons) {
  Features features(polygons);
  const Json root = read_json(polygons.file, kNeeded, [&](int depth, Event event, const Json& parsed) {
    return features.keep(depth, event, parsed);
  });
  constexpr std::array<std::string_view, 9> kTypes = {
      "FeatureCollection", "Feature",         "Polygon",    "MultiPolygon", "GeometryCollection",
      "LineString",        "MultiLineString", "MultiPoint", "Point"};
  if (!root.is_object() || std::ranges::find(kTypes, type_of(root)) == kTypes.end())
    throw Error(polygons.file + ": has no type of GeoJSON; " + std::string(kNeeded) + " is needed");
  polygons.file_crs = crs_of(root, polygons.file);
}

}  // namespace lacuna::io
