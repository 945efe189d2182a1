// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/compare_command.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs.hpp"
#include "io/write/report/report.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;
using namespace matching;
using nlohmann::ordered_json;

struct CompareArguments {
  fs::path before, after;
  double tolerance = 0;
  bool json = false, report = false, overwrite = false;
};

// Returns "12, 14".
std::string names_of(const std::vector<std::size_t>& loops) {
  std::string text;
  for (const std::size_t loop : loops) text += (text.empty() ? "" : ", ") + std::to_string(loop);
  return text.empty() ? "-" : text;
}

// Writes the page of a comparison into the folder of the second result.
fs::path write_changes(const Comparison& comparison, io::Overwrite overwrite) {
  const fs::path folder = comparison.after.folder, file = folder / "changes.html";
  io::check_output(file, io::kReportMark, overwrite);
  io::Scene scene = io::read_scene(folder);
  comparison.show_in(scene);
  io::write_report(scene, file, overwrite);
  return file;
}

void run_compare(const CompareArguments& arguments) {
  if (!(arguments.tolerance >= 0 && std::isfinite(arguments.tolerance)))
    throw WrongOption("--tolerance", "must be a length of 0 (automatic) or more");
  const Comparison comparison(read_result(arguments.before), read_result(arguments.after),
                              arguments.tolerance);
  print_warnings(comparison.warnings);
  if (arguments.json) {
    std::cout << comparison.json().dump(2) << "\n";
  } else {
    std::cout << visible(arguments.before.string()) << " and " << visible(arguments.after.string()) << ": "
              << comparison.print_counts() << "\n"
              << comparison.print_table();
  }
  if (!arguments.report) return;
  const fs::path file =
      write_changes(comparison, arguments.overwrite ? io::Overwrite::kAny : io::Overwrite::kOwn);
  if (!arguments.json) std::cout << "\nwritten: " << visible(file.string()) << "\n";
}

// Brings a result into another unit of length.
void scale(ComparedResult& result, double factor) {
  for (Eigen::Vector3d& point : result.scan.sample) point *= factor;
  for (double* const length : {&result.scan.spacing, &result.median_distance, &result.extent})
    *length *= factor;
  for (ComparedLoop& loop : result.scan.loops) {
    for (Eigen::Vector3d& point : loop.points) point *= factor;
    LoopMeasures& measures = loop.measures;
    for (double* const length : {&measures.perimeter, &measures.diameter, &measures.track.evidence.spacing})
      *length *= factor;
    measures.area *= factor * factor;
    measures.centroid *= factor;
  }
}

// Whether two results are in one system. Two texts may name one, and a system may be there in other units:
// then the same place has the same longitude and latitude. `factor` brings lengths of the first into the
// second.
bool is_in_one_system(const ComparedResult& a, const ComparedResult& b, double factor) {
  constexpr double kMetre = 1e-5;  // in degrees
  if (factor == 1 && io::is_same_crs(a.crs, b.crs)) return true;
  const auto first = io::scale_at(a.crs, a.middle), second = io::scale_at(b.crs, a.middle * factor);
  return first && second && std::abs(first->longitude - second->longitude) < kMetre &&
         std::abs(first->latitude - second->latitude) < kMetre;
}

std::string name_of(const ComparedResult& result) {
  return visible(result.folder.string());
}

// The way out of a side that does not state what the other one does.
std::string missing_on(const ComparedResult& without, const std::string& what, const ComparedResult& with,
                       const std::string& stated, const std::string& option) {
  return name_of(without) + ": its " + what + " is not known, and that of " + name_of(with) + " is " +
         stated + "; numbers are compared as they are, and `lacuna detect " + option + "` states it";
}

// Returns a line where the extents of two results are to each other as two units are; empty otherwise.
std::string like_other_units(const ComparedResult& a, const ComparedResult& b) {
  constexpr double kNear = 0.02;
  constexpr std::pair<double, const char*> kRatios[] = {{1000, "m and mm"},       {100, "m and cm"},
                                                        {1 / 0.3048, "m and ft"}, {1 / 0.0254, "m and in"},
                                                        {25.4, "in and mm"},      {304.8, "ft and mm"}};
  const double ratio = std::max(a.extent, b.extent) / std::min(a.extent, b.extent);
  for (const auto& [of_units, names] : kRatios) {
    if (!(std::abs(ratio / of_units - 1) <= kNear)) continue;
    return name_of(a) + " and " + name_of(b) + ": one is " + print_length(ratio, "") +
           " times as large as the other, as " + names +
           "; with `lacuna detect --unit` for both, lengths are converted";
  }
  return "";
}

}  // namespace

ComparedResult read_result(const fs::path& folder) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max() / 8;
  const io::Scene scene = io::read_scene(folder, {.positions = kAll, .loops = kAll});
  const auto text_of = [&](const char* key) {
    const auto& text = scene.holes.at(key);
    return text.is_string() ? text.get<std::string>() : "";
  };
  ComparedResult result{.folder = folder,
                        .scan = {.loops = {}, .sample = {}, .spacing = scene.points.spacing},
                        .median_distance = scene.holes.at("median_distance").get<double>(),
                        .extent = scene.bounds.isEmpty() ? 0 : scene.bounds.diagonal().norm(),
                        .unit = text_of("unit"),
                        .crs = text_of("crs")};
  if (!scene.bounds.isEmpty()) result.middle = scene.bounds.center();
  for (const Eigen::Vector3f& p : scene.points.positions) result.scan.sample.push_back(scene.place(p));
  for (std::size_t i = 0; i < scene.loops.measures.size(); ++i) {
    ComparedLoop& loop = result.scan.loops.emplace_back();
    loop.measures = scene.loops.measures[i];
    for (const Eigen::Vector3f& p : scene.loops.vertices_of(i)) loop.points.push_back(scene.place(p));
  }
  return result;
}

Comparison::Comparison(ComparedResult first, ComparedResult second, double length)
    : before(std::move(first)), after(std::move(second)), tolerance(length) {
  bring_together();
  constexpr double kDistances = 2;
  has_places = tolerance == 0;
  if (has_places) {
    tolerance = kDistances * std::max(before.median_distance, after.median_distance);
    for (ComparedResult* result : {&before, &after}) {
      for (ComparedLoop& loop : result->scan.loops)
        loop.tolerance = kDistances * loop.measures.track.evidence.spacing;
    }
  }
  changes = compare_loops(before.scan, after.scan, tolerance);
}

void Comparison::bring_together() {
  const auto metres = io::metres_of_unit(before.unit), metres_after = io::metres_of_unit(after.unit);
  const bool has_units = metres && metres_after;
  const double factor = has_units ? *metres / *metres_after : 1;
  if (before.crs.empty() != after.crs.empty()) {
    const auto& [without, with] = before.crs.empty() ? std::tie(before, after) : std::tie(after, before);
    warnings.push_back(missing_on(without, "coordinate reference system", with, crs_name(with.crs), "--crs"));
  } else if (!before.crs.empty() && !is_in_one_system(before, after, factor)) {
    throw Error(name_of(after) + ": its coordinate reference system is " + crs_name(after.crs) +
                ", and that of " + name_of(before) + " is " + crs_name(before.crs) +
                "; only results of one system can be compared");
  }
  if (has_units) {
    if (factor != 1) scale(before, factor);
    before.unit = after.unit;
    return;
  }
  if (const std::string line = like_other_units(before, after); !line.empty()) {
    warnings.push_back(line);
  } else if (before.unit != after.unit) {
    const auto& [without, with] = before.unit.empty() ? std::tie(before, after) : std::tie(after, before);
    warnings.push_back(missing_on(without, "unit", with, with.unit, "--unit"));
  }
}

std::string Comparison::print_counts() const {
  std::map<Change, std::size_t> counts;
  for (const LoopChange& change : changes) ++counts[change.change];
  std::string text;
  for (const auto& [change, count] : counts)
    text += (text.empty() ? "" : ", ") + print_count(count) + " " + std::string(name_of(change));
  return (text.empty() ? "no loops" : text) + "; curves of one hole are at most " +
         print_length(tolerance, after.unit) + " apart" +
         (has_places ? ", or twice the spacing along them" : "");
}

std::string Comparison::print_table() const {
  const auto loop_of = [&](const LoopChange& c) -> const LoopMeasures& {
    return c.after.empty() ? before.scan.loops[c.before[0]].measures : after.scan.loops[c.after[0]].measures;
  };
  std::vector<LoopChange> shown = changes;
  std::erase_if(shown, [](const LoopChange& c) { return c.change == Change::kSame; });
  if (shown.empty()) return "";
  std::stable_sort(shown.begin(), shown.end(), [&](const LoopChange& a, const LoopChange& b) {
    return loop_of(a).area > loop_of(b).area;
  });
  std::vector<std::vector<std::string>> rows = {
      {"change", "kind", "before", "after", "area before", "after", "centre"}};
  for (const LoopChange& c : shown) {
    const auto area = [&](const std::vector<std::size_t>& loops, const ComparedResult& result) {
      double sum = 0;
      for (const std::size_t loop : loops) sum += result.scan.loops[loop].measures.area;
      return loops.empty() ? "-" : print_area(sum, result.unit);
    };
    rows.push_back({std::string(name_of(c.change)), lacuna::name_of(loop_of(c).kind), names_of(c.before),
                    names_of(c.after), area(c.before, before), area(c.after, after),
                    print_place(loop_of(c).centroid, after.extent)});
  }
  return "\n" + tools::print_table(rows);
}

ordered_json Comparison::json() const {
  ordered_json json{{"tolerance", tolerance}, {"changes", ordered_json::array()}};
  for (const LoopChange& c : changes)
    json["changes"].push_back({{"change", name_of(c.change)}, {"before", c.before}, {"after", c.after}});
  return json;
}

void Comparison::show_in(io::Scene& scene) const {
  io::Scene::Loops& loops = scene.loops;
  scene.compared = before.folder.string();
  std::vector<const LoopChange*> change_of(after.scan.loops.size());
  for (const LoopChange& change : changes)
    for (const std::size_t loop : change.after) change_of[loop] = &change;
  const auto add = [&](const LoopChange& change) {
    std::string name(name_of(change.change));
    std::ranges::replace(name, ' ', '_');
    loops.changes.push_back(std::move(name));
    loops.earlier.push_back(change.before.empty() ? "" : names_of(change.before));
  };
  for (const std::uint64_t id : loops.ids) add(*change_of.at(id));

  Eigen::AlignedBox3d box;  // of the loops of the first result, which may lie beyond the second one
  std::vector<const LoopChange*> lost;
  for (const LoopChange& change : changes) {
    if (!change.after.empty()) continue;
    lost.push_back(&change);
    for (const std::size_t loop : change.before)
      for (const Eigen::Vector3d& point : before.scan.loops[loop].points) box.extend(point);
  }
  io::extend(scene, box);
  for (const LoopChange* const change : lost) {
    for (const std::size_t loop : change->before) {
      const ComparedLoop& drawn = before.scan.loops[loop];
      loops.ids.push_back(loops.all + loop);
      loops.measures.push_back({drawn.measures, {}});
      for (const Eigen::Vector3d& point : drawn.points)
        loops.vertices.push_back((point - scene.origin).cast<float>());
      loops.first.push_back(loops.vertices.size());
      add(*change);
    }
  }
}

void add_compare_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand(
      "compare", "Say which holes of two results are closed, opened, changed or the same");
  const auto arguments = std::make_shared<CompareArguments>();
  command.add_option("BEFORE", arguments->before, "Output folder of lacuna detect")
      ->required()
      ->type_name("DIR");
  command.add_option("AFTER", arguments->after, "Output folder of a later run on the same place")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--tolerance", arguments->tolerance,
                  "How far apart the curves of one hole may be, in units of the scan; 0: twice the "
                  "spacing of the place, and at least twice the median distance of neighbours")
      ->type_name("LENGTH");
  command.add_flag("--json", arguments->json, "Print the same as JSON, for programs");
  command.add_flag(
      "--report", arguments->report,
      "Write changes.html into AFTER: its page, with the loops of both and what has become of them");
  command.add_flag("--overwrite", arguments->overwrite,
                   "Replace a changes.html that Lacuna did not write, too");
  command.callback([arguments] { run_compare(*arguments); });
}

}  // namespace lacuna::tools
