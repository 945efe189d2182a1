// SPDX-License-Identifier: Apache-2.0
#include "engine/run/machine.hpp"
#include "io/read/files/number.hpp"
#include "io/write/loops/json.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/report/report.hpp"
#include "io/write/results/gis_results.hpp"
#include "io/write/results/results.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

// Returns the pose's 4 x 4 matrix, row by row.
Json rows_of(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(pose.matrix()(row, column));
  }
  return rows;
}

Json inputs(const ScanFiles& scan, const ScanCounts& counts) {
  const std::vector<std::uint64_t> rows = rows_of(scan, counts);
  Json files = Json::array();
  std::uint64_t first_id = 0;
  for (std::size_t i = 0; i < scan.files().size(); ++i) {
    Json file = Json::object();
    file["file"] = scan.files()[i].name.string();
    if (const auto& pose = scan.files()[i].pose) file["pose"] = rows_of(*pose);
    if (!scan.files()[i].crs.empty()) file["crs"] = scan.files()[i].crs;
    file["first_id"] = first_id;
    file["points"] = rows[i];
    first_id += rows[i];
    Json::object_t properties;  // names differ, so none is searched for
    for (const Property& property : scan.files()[i].layout.properties) {
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
          {"filtered_out", counts_of(filtered)},
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

Json levels_json(const std::vector<LevelSummary>& levels) {
  Json list = Json::array();
  for (const LevelSummary& level : levels)
    list.push_back({{"edge", level.edge}, {"points", level.points}, {"loops", level.loops}});
  return list;
}

// Returns null if the value is not known.
Json cause_json(const LoopCause& cause) {
  if (cause.name().empty()) return {};
  Json json = {{"main", cause.name()}, {"shares", Json::object()}, {"hidden_by", Json()}};
  for (std::size_t i = 0; i < kCauses; ++i) json["shares"][std::string(kCauseNames[i])] = cause.shares[i];
  if (cause.hidden_from >= 0) {
    json["hidden_by"] = {{"place", list(cause.hidden_by)},
                         {"extent", cause.hidden_by_extent},
                         {"station", cause.hidden_from},
                         {"from", list(cause.hidden_from_place)}};
  }
  return json;
}

Json head(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config) {
  const Summary& summary = detection.summary;
  Json json = begin_json(kHolesSchema);
  put_crs(scan, json);
  json["parameters"] = parameter_values(
      config, [](std::string_view section) { return section != "run" && section != "area"; });
  json["inputs"] = inputs(scan, detection.counts);
  json["counts"] = counts(summary.counts, detection.counts.filtered_out, detection.loops);
  json["bounds"] = corners(summary.bounds);
  json["strays"] = strays_json(summary.strays);
  const LocalOffset offset = local_offset(detection, config.output);
  json["offset"] = offset ? list(*offset) : Json();
  json["probability"] = summary.probabilities;
  json["resolution"] = summary.resolution;
  json["levels"] = levels_json(summary.levels);
  json["mean_neighbours"] = summary.mean_neighbours;
  json["mean_edge_length"] = summary.mean_edge_length;
  json["median_distance"] = summary.median_distance;
  json["stations"] = stations_json(detection.stations);
  json["surface_area"] = summary.surface_area;
  json["hole_area"] = summary.hole_area;
  const auto openings = detection.opening_area();
  json["opening_area"] = openings ? Json(*openings) : Json();
  json["eps"] = summary.eps;
  json["e"] = summary.e;
  return json;
}

// Writes `"key":[...]` of a list that may be larger than memory: `put(element)` writes an element.
void write_list(std::string_view key, OutputFile& out,
                const std::function<void(const std::function<void(const Json&)>& put)>& for_each) {
  out.write(",\"" + std::string(key) + "\":[");
  bool is_first = true;
  for_each([&](const Json& element) {
    out.write((is_first ? "" : ",") + print(element, -1));
    is_first = false;
  });
  out.write("]");
}

Json evidence_json(const LoopEvidence& evidence) {
  return {{"clearness", evidence.clearness},
          {"surface", evidence.surface},
          {"spacing", evidence.spacing},
          {"sampling_gap", evidence.sampling_gap},
          {"width", evidence.width},
          {"compactness", evidence.compactness},
          {"persistence", evidence.persistence},
          {"goes_on", evidence.beyond.goes_on},
          {"layers", evidence.beyond.layers},
          {"volume", evidence.beyond.volume},
          {"alike", evidence.alike}};
}

// Writes point by point, since a loop may be larger than memory.
void write_loop(std::size_t id, const ExplainedDetection& detection, bool with_coordinates, OutputFile& out) {
  const ExplainedLoop measures = detection.loop(id);
  const Json head = {{"id", id},
                     {"kind", name_of(measures.kind)},
                     {"parent", measures.parent < 0 ? Json() : Json(measures.parent)},
                     {"confidence", measures.track.confidence},
                     {"prominence", measures.track.evidence.prominence},
                     {"evidence", evidence_json(measures.track.evidence)},
                     {"first_scale", measures.track.first_scale},
                     {"last_scale", measures.track.last_scale},
                     {"perimeter", measures.perimeter},
                     {"area", measures.area},
                     {"diameter", measures.diameter},
                     {"planarity", measures.planarity},
                     {"mean_probability", measures.mean_probability},
                     {"centroid", list(measures.centroid)},
                     {"normal", list(measures.normal)},
                     {"cause", cause_json(measures.cause)},
                     {"tiles", measures.tiles},
                     {"points", measures.points}};
  std::string text = print(head, -1);
  text.pop_back();  // its closing brace
  out.write(text);
  write_list("ids", out, [&](const auto& put) {
    detection.for_each_loop_point(id, [&](const LoopPoint& point) { put(value(point.id)); });
  });
  if (with_coordinates) {
    write_list("coordinates", out, [&](const auto& put) {
      detection.for_each_loop_point(id, [&](const LoopPoint& point) { put(list(point.position())); });
    });
  }
  out.write("}");
}

}  // namespace

void write_holes(const ExplainedDetection& detection, const ScanFiles& scan, const FilesConfig& config,
                 OutputFile& out) {
  std::string text = print(head(detection, scan, config), 2);
  text.resize(text.size() - 2);  // without its "\n}": the loops follow
  out.write(text);
  out.write(",\n  \"loops\": [");
  for (std::size_t i = 0; i < detection.loops.size(); ++i) {
    out.write(i == 0 ? "\n    " : ",\n    ");
    write_loop(i, detection, !config.output.no_coordinates, out);
  }
  out.write(detection.loops.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

namespace {

double points_per_second(std::uint64_t points, double seconds) {
  return static_cast<double>(points) / seconds;
}

}  // namespace

void write_run(const Detection& detection, const ScanFiles& scan, const FilesConfig& config,
               OutputFile& out) {
  const Summary& summary = detection.summary;
  Json json = begin_json("run 1");
  json["parameters"] = parameter_values(config, [](std::string_view section) { return section == "run"; });
  put_crs(scan, json);
  json["points"] = summary.counts.points;
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
  const std::uint64_t peak = peak_memory();
  json["peak_memory_bytes"] = peak > 0 ? Json(peak) : Json();
  json["cores"] = std::thread::hardware_concurrency();
  out.write(print(json, 2) + "\n");
}

namespace {

// Writes an empty field if the value is not finite.
void append(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) append_shortest(line, value);
}

std::string table_header(bool has_lids) {
  std::string names = "id,kind";
  for (const LoopMeasure& measure : kTableMeasures) names.append(",").append(measure.name);
  if (has_lids) names += ",lid_area";
  return names + ",x,y,z,nx,ny,nz,cause,hidden_by_x,hidden_by_y,hidden_by_z\n";
}

// Holes before outer curves, each the largest first.
std::vector<std::size_t> by_size(const std::vector<LoopMeasures>& loops) {
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t id) {
    const double area = std::isfinite(loops[id].area) ? loops[id].area : std::numeric_limits<double>::max();
    return std::tuple(loops[id].kind, -area, id);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

}  // namespace

void write_table(const ExplainedDetection& detection, const std::vector<LidMeasures>& lids, OutputFile& out) {
  constexpr int kDigits = 7, kDigitsOfCount = 16;
  const int decimals = place_decimals(detection.summary.median_distance);
  const auto place = [decimals](double value) { return reread(value, std::chars_format::fixed, decimals); };
  out.write(table_header(!lids.empty()));
  for (const std::size_t id : by_size(detection.loops)) {
    const ExplainedLoop loop = detection.loop(id);
    std::string line = std::to_string(id) + "," + name_of(loop.kind);
    for (const LoopMeasure& measure : kTableMeasures) {
      const int digits = measure.is_count ? kDigitsOfCount : kDigits;
      append(line, reread(measure.of(loop), std::chars_format::general, digits));
    }
    if (!lids.empty()) append(line, reread(lids[id].area, std::chars_format::general, kDigits));
    for (const double coordinate : loop.centroid) append(line, place(coordinate));
    for (const double component : loop.normal)
      append(line, reread(component, std::chars_format::general, kDigits));
    line.append(",").append(loop.cause.name());
    for (const double coordinate : loop.cause.hidden_by) append(line, place(coordinate));
    out.write(line + "\n");
  }
}

namespace {

Json void_json(std::size_t id, const Void& each, const AreaCheck& check) {
  Json shares = Json::object();
  for (std::size_t i = 0; i < check.classes.size(); ++i) shares[check.classes[i].name] = each.shares[i];
  return {{"id", id},
          {"kind", name_of(each.kind)},
          {"counts", each.counts},
          {"area", each.area},
          {"circle", each.circle},
          {"middle", {each.middle.x(), each.middle.y()}},
          {"spacing", each.spacing},
          {"excepted", each.excepted},
          {"classes", shares}};
}

Json polygon_json(const AreaPolygon& polygon, const AreaCheck& check) {
  return {{"answer", name_of(check.answer_of(polygon))},
          {"area", polygon.area},
          {"covered", polygon.covered()},
          {"circle", polygon.circle}};
}

Json tile_json(const AreaTile& tile) {
  return {{"corner", {tile.corner.x(), tile.corner.y()}},
          {"area", tile.area},
          {"covered", tile.covered()},
          {"voids", tile.voids},
          {"points", tile.points},
          {"density", tile.density()},
          {"spacing", tile.spacing()}};
}

// Writes rings corner by corner: as JSON in memory they would take ten times the space.
void write_rings(const PlanPolygon& polygon, OutputFile& out) {
  std::string text = "[";
  for (const Ring2& ring : polygon) {
    text += &ring == &polygon.front() ? "[" : ",[";
    for (const Eigen::Vector2d& corner : ring) {
      text += &corner == &ring.front() ? "" : ",";
      text += print(Json::array({corner.x(), corner.y()}), -1);
      out.write(std::exchange(text, ""));
    }
    text += "]";
  }
  out.write(text + "]");
}

// Writes an object with one more member, the outline.
void write_outlined(std::string object, const PlanPolygon& outline, OutputFile& out) {
  object.back() = ',';
  out.write(object + "\"outline\":");
  write_rings(outline, out);
  out.write("}");
}

// Writes `"key":[...]`, a line for each element.
template <class List, class Write>
void write_list(std::string_view key, const List& elements, const Write& write, OutputFile& out) {
  out.write(",\n  \"" + std::string(key) + "\": [");
  for (std::size_t i = 0; i < elements.size(); ++i) {
    out.write(i == 0 ? "\n    " : ",\n    ");
    write(i);
  }
  out.write("]");
}

void write_json(const AreaCheck& check, const ScanFiles& scan, const AreaConfig& config, OutputFile& out) {
  Json head = begin_json(kVoidsSchema);
  put_crs(scan, head);
  head["file"] = config.area.empty() ? Json() : Json(config.area);
  head["left_out"] = check.is_outline ? Json(check.left_out) : Json();
  head["except"] = config.except.empty() ? Json() : Json(config.except);
  head["basis"] = Json::array();
  for (const auto& [thing, what] : check.basis) head["basis"].push_back({thing, what});
  head["not_shown"] = kNotShown;
  head["void_rule"] = config.void_rule;
  head["void_size"] = check.void_size;
  head["answer"] = name_of(check.answer());
  head["undecided"] = Json::array();
  for (const Undecided reason : check.undecided) head["undecided"].push_back(name_of(reason));
  head["counting"] = check.counting();
  head["area"] = check.area;
  head["voids_area"] = check.voids_area;
  head["missing_area"] = check.missing_area;
  head["classes"] = Json::array();
  for (const AreaClass& each : check.classes)
    head["classes"].push_back({{"name", each.name}, {"voids_area", each.voids_area}});
  head["points"] = check.points;
  head["spacing"] = check.spacing;
  head["tile_edge"] = check.tile_edge;
  std::string text = print(head, 2);
  text.resize(text.rfind('}'));
  while (text.back() == '\n') text.pop_back();
  out.write(text);
  const auto write_polygon = [&](std::size_t i) {
    write_outlined(print(polygon_json(check.polygons[i], check), -1), check.polygons[i].outline, out);
  };
  const auto write_void = [&](std::size_t i) {
    write_outlined(print(void_json(i, check.voids[i], check), -1), check.voids[i].outline, out);
  };
  write_list("polygons", check.polygons, write_polygon, out);
  write_list("voids", check.voids, write_void, out);
  write_list(
      "tiles", check.tiles, [&](std::size_t i) { out.write(print(tile_json(check.tiles[i]), -1)); }, out);
  out.write("\n}\n");
}

void write_table(const AreaCheck& check, OutputFile& out) {
  out.write("id,kind,counts");
  for (const VoidColumn& column : kVoidColumns) out.write("," + std::string(column.name));
  for (const AreaClass& each : check.classes) out.write("," + std::string(kShareColumn) + each.name);
  out.write("\n");
  for (std::size_t id = 0; id < check.voids.size(); ++id) {
    const Void& each = check.voids[id];
    std::string line = std::to_string(id);
    line.append(",").append(name_of(each.kind)).append(each.counts ? ",1" : ",0");
    std::vector<double> values;
    for (const VoidColumn& column : kVoidColumns) values.push_back(column.of(each));
    values.insert(values.end(), each.shares.begin(), each.shares.end());
    for (const double value : values) {
      line += ',';
      if (std::isfinite(value)) append_shortest(line, value);
    }
    out.write(line + "\n");
  }
}

}  // namespace

std::vector<std::filesystem::path> write_voids(const AreaCheck& check, const ScanFiles& scan,
                                               const FilesConfig& config, ResultFolder& folder) {
  folder.add(
      "voids.gpkg", [&](OutputFile& out) { write_voids_gpkg(check, scan, out); }, Writer::kLibrary);
  folder.add("voids.csv", [&](OutputFile& out) { write_table(check, out); });
  folder.add(kVoidsFile, [&](OutputFile& out) { write_json(check, scan, config.area, out); });
  if (config.output.report) {
    const auto& files = scan.files();
    const std::string title =
        files.size() == 1 ? files.front().name.filename().string() : std::to_string(files.size()) + " files";
    folder.add("report.html", [&](OutputFile& out) { write_area_sheet(folder.staged(), title, out); });
  }
  scan.check_unchanged();
  return folder.commit();
}

}  // namespace lacuna::io
