// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/voids.hpp"

#include "io/read/files/number.hpp"
#include "io/write/loops/json.hpp"
#include "io/write/report/report.hpp"
#include "io/write/results/gis_results.hpp"
#include "io/write/results/results.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace lacuna::io {
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

void add_voids(const AreaCheck& check, const ScanFiles& scan, const AreaConfig& config,
               const ResultFolder& folder) {
  folder.add(
      "voids.gpkg", [&](OutputFile& out) { write_voids_gpkg(check, scan, out); }, Writer::kLibrary);
  folder.add("voids.csv", [&](OutputFile& out) { write_table(check, out); });
  folder.add(kVoidsFile, [&](OutputFile& out) { write_json(check, scan, config, out); });
}

std::vector<std::filesystem::path> write_voids(const AreaCheck& check, const ScanFiles& scan,
                                               const FilesConfig& config, ResultFolder& folder) {
  add_voids(check, scan, config.area, folder);
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
