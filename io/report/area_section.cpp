// SPDX-License-Identifier: Apache-2.0
#include "io/report/area_section.hpp"

#include "engine/run/error.hpp"
#include "io/area/voids_form.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::io {
namespace {

constexpr std::size_t kMostVoids = 500, kMostTiles = 2000;
constexpr double kStepsOfMap = 800;  // a map shows nothing finer than this part of its extent

// Leaves out corners that lie nearer than `step` to the one before.
Json coarse_rings(const Json& rings, double step) {
  Json coarse = Json::array();
  for (const Json& ring : rings) {
    Json& corners = coarse.emplace_back(Json::array());
    double x = HUGE_VAL, y = HUGE_VAL;
    for (const Json& corner : ring) {
      const double next_x = corner.at(0).get<double>(), next_y = corner.at(1).get<double>();
      if (std::hypot(next_x - x, next_y - y) < step) continue;
      corners.push_back(corner);
      x = next_x;
      y = next_y;
    }
    if (corners.size() < 3) coarse.erase(coarse.size() - 1);
  }
  return coarse;
}

double extent_of(const Json& polygons) {
  double low[] = {HUGE_VAL, HUGE_VAL}, high[] = {-HUGE_VAL, -HUGE_VAL};
  for (const Json& polygon : polygons) {
    for (const Json& ring : polygon.at("outline")) {
      for (const Json& corner : ring) {
        for (const std::size_t axis : {0, 1}) {
          low[axis] = std::min(low[axis], corner.at(axis).get<double>());
          high[axis] = std::max(high[axis], corner.at(axis).get<double>());
        }
      }
    }
  }
  return std::max(high[0] - low[0], high[1] - low[1]);
}

void keep_first(Json& list, std::size_t most) {
  if (list.size() > most) list.erase(list.begin() + static_cast<std::ptrdiff_t>(most), list.end());
}

}  // namespace

Json read_area_section(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kVoidsFile;
  if (!std::filesystem::exists(file)) return nullptr;
  try {
    Json area = read_json(file);
    if (area.at("schema") != kVoidsSchema)
      throw Error(file.string() + ": its schema is " + print(area.at("schema"), -1) + "; \"" +
                  std::string(kVoidsSchema) + "\" is read");
    const double step = extent_of(area.at("polygons")) / kStepsOfMap;
    area["all"] = area.at("voids").size();
    keep_first(area.at("voids"), kMostVoids);
    keep_first(area.at("tiles"), kMostTiles);
    for (const char* const list : {"polygons", "voids"}) {
      for (Json& each : area.at(list)) each.at("outline") = coarse_rings(each.at("outline"), step);
    }
    return area;
  } catch (const Json::exception& error) {
    throw Error(file.string() + ": is not as lacuna writes it: " + error.what());
  }
}

}  // namespace lacuna::io
