// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/compare_command.hpp"

#include "engine/run/error.hpp"
#include "io/report/scene.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/matching/compare_loops.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;
using namespace matching;
using nlohmann::ordered_json;

struct CompareArguments {
  fs::path before, after;
  double tolerance = 0;
  bool json = false;
};

// Returns "12, 14".
std::string names_of(const std::vector<std::size_t>& loops) {
  std::string text;
  for (const std::size_t loop : loops) text += (text.empty() ? "" : ", ") + std::to_string(loop);
  return text.empty() ? "-" : text;
}

void run_compare(const CompareArguments& arguments) {
  if (!(arguments.tolerance >= 0 && std::isfinite(arguments.tolerance)))
    throw WrongOption("--tolerance", "must be a length of 0 (automatic) or more");
  const Comparison comparison(read_result(arguments.before), read_result(arguments.after),
                              arguments.tolerance);
  if (arguments.json) {
    std::cout << comparison.json().dump(2) << "\n";
  } else {
    std::cout << visible(arguments.before.string()) << " and " << visible(arguments.after.string()) << ": "
              << comparison.print_counts() << "\n"
              << comparison.print_table();
  }
}

}  // namespace

ComparedResult read_result(const fs::path& folder) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max() / 8;
  const io::Scene scene = io::read_scene(folder, {.positions = kAll, .loops = kAll});
  const auto place_of = [&](const Eigen::Vector3f& p) -> Eigen::Vector3d {
    return scene.origin + p.cast<double>();
  };
  ComparedResult result{
      .scan = {.loops = {}, .sample = {}, .spacing = scene.points.spacing},
      .median_distance = scene.holes.at("median_distance").get<double>(),
      .extent = scene.bounds.isEmpty() ? 0 : scene.bounds.diagonal().norm(),
      .unit = scene.holes.at("unit").is_string() ? scene.holes.at("unit").get<std::string>() : ""};
  for (const Eigen::Vector3f& p : scene.points.positions) result.scan.sample.push_back(place_of(p));
  for (std::size_t i = 0; i < scene.loops.measures.size(); ++i) {
    ComparedLoop& loop = result.scan.loops.emplace_back();
    loop.measures = scene.loops.measures[i];
    for (std::size_t v = scene.loops.first[i]; v < scene.loops.first[i + 1]; ++v)
      loop.points.push_back(place_of(scene.loops.vertices[v]));
  }
  return result;
}

Comparison::Comparison(ComparedResult first, ComparedResult second, double length)
    : before(std::move(first)), after(std::move(second)), tolerance(length) {
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

void add_compare_command(const Command& program) {
  const Command command = program.add_command(
      "compare", "Say which holes of two results are closed, opened, changed or the same");
  const auto arguments = std::make_shared<CompareArguments>();
  command.add_option("BEFORE", arguments->before, "Output folder of lacuna detect").required().type("DIR");
  command.add_option("AFTER", arguments->after, "Output folder of a later run on the same place")
      .required()
      .type("DIR");
  command
      .add_option("--tolerance", arguments->tolerance,
                  "How far apart the curves of one hole may be, in units of the scan; 0: twice the "
                  "spacing of the place, and at least twice the median distance of neighbours")
      .type("LENGTH");
  command.add_flag("--json", arguments->json, "Print the same as JSON, for programs");
  command.runs([arguments] { run_compare(*arguments); });
}

}  // namespace lacuna::tools
