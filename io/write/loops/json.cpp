// SPDX-License-Identifier: Apache-2.0
#include "io/write/loops/json.hpp"

#include "io/read/scan/scan_files.hpp"

#include <cmath>
#include <variant>

namespace lacuna::io {
namespace {

template <class Value>
Json json_value(const Value* value) {
  return *value;
}
Json json_value(const NamedValue& value) {
  return value.names[*value.value];
}

}  // namespace

Json begin_json(std::string_view schema) {
  return {{"lacuna", LACUNA_VERSION}, {"schema", schema}};
}

std::string print(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json list(const Eigen::Vector3d& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

Json corners(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? Json() : Json({{"min", list(box.min())}, {"max", list(box.max())}});
}

Json strays_json(const Strays& strays) {
  return {{"points", strays.points},
          {"example", strays.points > 0 ? list(strays.example) : Json()},
          {"rest", corners(strays.rest)}};
}

Json stations_json(const std::vector<StationSummary>& stations) {
  Json list_of_all = Json::array();
  for (const StationSummary& station : stations) {
    list_of_all.push_back({{"name", station.name},
                           {"place", list(station.place)},
                           {"path", station.path},
                           {"points", station.points},
                           {"certainty", station.certainty},
                           {"counts", std::isnan(station.certainty) ? Json() : Json(station.counts())},
                           {"lowest_sine", station.lowest},
                           {"highest_sine", station.highest},
                           {"turn", station.turn},
                           {"step", station.step},
                           {"farthest", station.farthest}});
  }
  return list_of_all;
}

Json counts_of(const FilteredOut& filtered) {
  Json counts;
  for (const FilterCount& filter : kFilterCounts) counts[filter.key] = filtered.*filter.count;
  return counts;
}

void put_crs(const ScanFiles& scan, Json& json) {
  json["crs"] = scan.common_crs().empty() ? Json() : Json(scan.common_crs());
  json["unit"] = scan.length_unit();
}

Json parameter_values(FilesConfig config, const std::function<bool(std::string_view section)>& is_wanted) {
  Json sections = Json::object();
  for (const Parameter& parameter : parameters(config)) {
    if (!is_wanted(parameter.section)) continue;
    Json& entry = sections[std::string(parameter.section)][std::string(parameter.key)];
    std::visit([&](const auto& value) { entry = json_value(value); }, parameter.value);
  }
  return sections;
}

}  // namespace lacuna::io
