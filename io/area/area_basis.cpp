// SPDX-License-Identifier: Apache-2.0
#include "io/area/area_basis.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <spdlog/fmt/fmt.h>

namespace lacuna::io {
namespace {

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string print(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::size_t files_with(const ScanFiles& scan, const char* column) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scan.files(), [&](const ScanFile& file) { return file.layout.find_alike(column) != nullptr; }));
}

std::string returns_of(const ScanFiles& scan) {
  const std::size_t stated = files_with(scan, "return_number"), files = scan.files().size();
  if (stated == 0) return "all: no file states them";
  if (stated == files) return "first ones alone";
  return "first ones alone; all points of " + counted(files - stated, "file") + ", which state none";
}

std::string classes_of(const ScanFiles& scan, const InputConfig& config) {
  const bool is_stated = files_with(scan, "classification") > 0;
  std::string text = !is_stated          ? "all: no file states them"
                     : config.keep_noise ? "all"
                                         : "all but noise of LAS, 7 and 18";
  if (!config.where.empty()) text += ", where " + config.where;
  return text;
}

std::string swaths_of(const AreaCheck& check, const ScanFiles& scan) {
  if (files_with(scan, "point_source_id") == 0) return "all: no file states them";
  return counted(check.swaths.size(), "value") + " of point_source_id, taken together";
}

}  // namespace

std::vector<BasisLine> basis_of(const AreaCheck& check, const ScanFiles& scan, const FilesConfig& config) {
  const std::string& unit = scan.length_unit();
  std::string polygons = (check.is_outline ? "the scan's own outline" : config.area.area) + ", " +
                         counted(check.polygons.size(), "polygon");
  if (check.is_outline)
    polygons += ", without " + print(check.left_out, unit.empty() ? "" : unit + "²") + " of its convex hull";
  if (!config.area.except.empty()) polygons += "; voids in " + config.area.except + " do not count";
  const std::string least = print(check.void_size, unit);
  const std::string& rule = config.area.void_rule;
  std::string point = "covers what is nearer than " + print(check.void_size / 2, unit);
  if (std::isfinite(check.spacing)) point += "; spacing " + print(check.spacing, unit) + " where points are";
  if (!config.area.classes.empty()) polygons += "; map of " + config.area.classes;
  return {{"area", polygons},
          {"voids", "circles of " + least + " or more without points" +
                        (rule.find(':') == rule.npos ? "" : ", by the rule " + rule)},
          {"returns", returns_of(scan)},
          {"point classes", classes_of(scan, config.input)},
          {"swaths", swaths_of(check, scan)},
          {"a point", point}};
}

}  // namespace lacuna::io
