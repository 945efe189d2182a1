#include "io/results/results.hpp"
#include "io/scalar.hpp"

#include <fstream>
#include <sstream>
#include <variant>

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order given; what is not finite is printed as null

// A path need not be UTF-8, the report must be.
std::string print(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

template <class Vector>
Json list(const Vector& vector) {
  return Json{vector[0], vector[1], vector[2]};
}

// Its 4 x 4 matrix, row by row.
Json rows_of(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(pose.matrix()(row, column));
  }
  return rows;
}

template <class Value>
Json json_value(const Value* value) {
  return *value;
}
Json json_value(const NamedValue& value) {
  return value.names[*value.value];
}

Json parameter_values(Config config) {
  Json sections = Json::object();
  for (const Parameter& parameter : parameters(config)) {
    Json& entry = sections[std::string(parameter.section)][std::string(parameter.key)];
    std::visit([&](const auto& value) { entry = json_value(value); }, parameter.value);
  }
  return sections;
}

Json inputs(const FileScan& scan) {
  Json files = Json::array();
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    Json file = Json::object();
    file["file"] = scan.files()[i].string();
    if (const auto& pose = scan.poses()[i]) file["pose"] = rows_of(*pose);
    if (!scan.crs()[i].empty()) file["crs"] = scan.crs()[i];
    const auto& rows = scan.expected_rows()[i];
    file["points"] = rows ? Json(*rows) : Json(nullptr);
    Json::object_t properties;  // names differ, so none is searched for
    for (const Property& property : scan.layouts()[i].properties) {
      properties.emplace_back(property.name, ply_name(property.type));
    }
    file["properties"] = std::move(properties);
    files.push_back(std::move(file));
  }
  return files;
}

Json counts(const Counts& counts, const FilteredOut& filtered, const std::vector<LoopMeasures>& loops) {
  std::uint64_t holes = 0;
  for (const LoopMeasures& loop : loops) holes += loop.kind == LoopKind::kHole ? 1 : 0;
  return {{"points", counts.points},
          {"dropped", counts.dropped - filtered.total()},
          {"filtered_out",
           {{"origin", filtered.origin},
            {"bounds", filtered.bounds},
            {"classes", filtered.classes},
            {"returns", filtered.returns}}},
          {"thinned_out", counts.thinned_out},
          {"duplicates", counts.duplicates},
          {"candidates", counts.candidates},
          {"coherent", counts.coherent},
          {"boundary_points", counts.boundary_points},
          {"boundary_edges", counts.boundary_edges},
          {"components", counts.components},
          {"raw_loops", counts.raw_loops},
          {"loops", loops.size()},
          {"holes", holes},
          {"outer", loops.size() - holes},
          {"undefined_normals", counts.undefined_normals}};
}

double points_per_second(std::uint64_t points, double seconds) {
  return static_cast<double>(points) / seconds;
}

// The most memory this process has held so far.
Json peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string key;
    std::uint64_t kilobytes = 0;
    if (words >> key && key == "VmHWM:" && words >> kilobytes) return kilobytes * 1024;
  }
  return nullptr;
}

Json head(const Detection& detection, const FileScan& scan, const Config& config) {
  const Summary& summary = detection.summary();
  Json json;
  json["lacuna"] = LACUNA_VERSION;
  json["parameters"] = parameter_values(config);
  json["inputs"] = inputs(scan);
  json["crs"] = nullptr;
  if (const std::string crs = scan.common_crs(); !crs.empty()) json["crs"] = crs;
  json["counts"] = counts(summary.counts, scan.filtered_out(), detection.loops());
  json["bounds"] = nullptr;
  if (!summary.bounds.isEmpty()) {
    json["bounds"] = {{"min", list(summary.bounds.min())}, {"max", list(summary.bounds.max())}};
  }
  json["resolution"] = summary.resolution;
  json["mean_neighbours"] = summary.mean_neighbours;
  json["mean_edge_length"] = summary.mean_edge_length;
  json["eps"] = summary.eps;
  json["e"] = summary.e;
  json["tiling"] = {{"tiles", summary.tiles},
                    {"tile_points", summary.tile_points},
                    {"threads", summary.threads},
                    {"memory_limit_bytes", summary.memory_limit}};
  json["phases"] = Json::array();
  double total_seconds = 0;
  for (const PhaseTime& phase : summary.phases) {
    json["phases"].push_back(
        {{"name", phase.name},
         {"seconds", phase.seconds},
         {"points_per_second", points_per_second(summary.counts.points, phase.seconds)}});
    total_seconds += phase.seconds;
  }
  json["total_seconds"] = total_seconds;
  json["points_per_second"] = points_per_second(summary.counts.points, total_seconds);
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

Json record(const ReportedLoop& loop) {
  const LoopMeasures& measures = loop.measures;
  Json ids = Json::array();
  for (const LoopPoint& point : loop.points) ids.push_back(value(point.id));
  return {{"kind", measures.kind == LoopKind::kHole ? "hole" : "outer"},
          {"points", std::move(ids)},
          {"perimeter", measures.perimeter},
          {"area", measures.area},
          {"diameter", measures.diameter},
          {"centroid", list(measures.centroid)},
          {"normal", list(measures.normal)},
          {"planarity", measures.planarity},
          {"mean_probability", measures.mean_probability},
          {"confidence", measures.confidence},
          {"tiles", measures.tiles}};
}

}  // namespace

void write_report(const Detection& detection, const FileScan& scan, const Config& config, OutputFile& out) {
  std::string text = print(head(detection, scan, config), 2);
  text.resize(text.size() - 2);  // without its "\n}": the loops follow, one in memory at a time
  out.write(text);
  out.write(",\n  \"loops\": [");
  for (std::size_t i = 0; i < detection.loops().size(); ++i) {
    out.write(i == 0 ? "\n    " : ",\n    ");
    out.write(print(record(detection.read_loop(i)), -1));
  }
  out.write(detection.loops().empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace lacuna
