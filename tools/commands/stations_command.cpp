// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "engine/run/parallel.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "io/explain/stations/station.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/rows/columns.hpp"
#include "io/write/report/scene.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/run_program.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

struct StationsArguments {
  fs::path folder;
  std::optional<fs::path> places;  // a file with places of the scanner; empty: over the floor
  std::size_t count = 5;
  double height = 0, range = 0, incidence = 10, grid = 0;  // lengths of 0 are chosen automatically
  bool overwrite = false;
};

// Positions of the sample and of hidden places, in the coordinates of the scan.
struct HiddenScan {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<InnerSample> hidden;
  double area = 0;
  bool has_causes = false;  // else all holes count
};

// Returns the share that another station can measure: what is hidden or out of view. Without causes, it is
// the whole hole.
double share_to_see(const LoopCause& cause) {
  return cause.main() ? cause.share(Cause::kHidden) + cause.share(Cause::kOutOfView) : 1;
}

HiddenScan hidden_in(const Scene& scene) {
  HiddenScan found;
  for (const Eigen::Vector3f& p : scene.points.positions) found.points.push_back(scene.place(p));
  found.normals = scene.points.normals;
  std::vector<Eigen::Vector3d> loop;
  for (std::size_t i = 0; i < scene.loops.ids.size(); ++i) {
    const ExplainedLoop& measures = scene.loops.measures[i];
    const double share = share_to_see(measures.cause);
    found.has_causes |= measures.cause.main().has_value();
    if (measures.kind != LoopKind::kHole || !(share > 0)) continue;
    loop.clear();
    for (const Eigen::Vector3f& p : scene.loops.vertices_of(i)) loop.push_back(scene.place(p));
    for (InnerSample& inside : inside_places(loop)) {
      inside.area *= share;
      found.area += inside.area;
      found.hidden.push_back(inside);
    }
  }
  return found;
}

constexpr double kHeight = 1.6, kRange = 30;  // metres
constexpr double kVoxel = 3;                  // of obstacles, in spacings of the sample

// One of so many places represents the others, so that rays take seconds.
void thin(std::vector<InnerSample>& places) {
  constexpr std::size_t kMost = 6000;
  const std::size_t step = (places.size() + kMost - 1) / kMost;
  if (step < 2) return;
  std::vector<InnerSample> kept;
  for (std::size_t i = 0; i < places.size(); i += step) {
    kept.push_back(places[i]);
    for (std::size_t j = i + 1; j < std::min(i + step, places.size()); ++j)
      kept.back().area += places[j].area;
  }
  places.swap(kept);
}

double farthest_of(const Json& stations) {
  double farthest = 0;
  for (const Json& station : stations) farthest = std::max(farthest, station.at("farthest").get<double>());
  return farthest;
}

std::vector<Eigen::Vector3d> eyes_of(std::span<const NextStation> chosen) {
  std::vector<Eigen::Vector3d> eyes;
  for (const NextStation& station : chosen) eyes.push_back(station.eye);
  return eyes;
}

// `tried` has the places that `chosen` is from.
void write_places(const fs::path& file, Overwrite overwrite, const Scene& scene,
                  std::span<const NextStation> chosen, std::span<const ListedPosition> tried, double hidden) {
  const Json& crs = scene.holes.at("crs");
  const std::vector<Eigen::Vector3d> eyes = eyes_of(chosen);
  const auto degrees = to_degrees(crs.is_string() ? crs.get<std::string>() : "", eyes, file);
  Json json = {{"type", "FeatureCollection"}, {"name", "lacuna_next_stations"}};
  json["crs_of_coordinates"] = degrees ? Json(kDegreesCrs) : crs;
  json["crs_of_x_y_z"] = crs;
  json["hidden_area"] = hidden;
  json["features"] = Json::array();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Json properties = {{"rank", i + 1}};
    if (const std::string& name = tried[chosen[i].index].name; !name.empty()) properties["name"] = name;
    properties["area"] = chosen[i].area;
    properties["share"] = chosen[i].area / hidden;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      properties[kPositionNames[static_cast<std::size_t>(axis)]] = eyes[i][axis];
    json["features"].push_back(
        {{"type", "Feature"},
         {"geometry", {{"type", "Point"}, {"coordinates", list(degrees ? (*degrees)[i] : eyes[i])}}},
         {"properties", properties}});
  }
  NewFile out(file, kNextStationsMark, overwrite);
  out.content().write(print(json, 2) + "\n");
  note_result(file.parent_path(), file.filename().string());
  out.commit();
}

void print_places(const Scene& scene, std::span<const NextStation> chosen,
                  std::span<const ListedPosition> tried, double hidden, const std::string& unit) {
  const bool has_names = std::any_of(tried.begin(), tried.end(),
                                     [](const ListedPosition& place) { return !place.name.empty(); });
  std::vector<std::vector<std::string>> rows = {
      {"next station", "place of the scanner", "sees", "of what is hidden", "with those before"}};
  double sum = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    sum += chosen[i].area;
    rows.push_back({std::to_string(i + 1), print_place(chosen[i].eye, scene.edge),
                    print_area(chosen[i].area, unit), print_share(chosen[i].area / hidden),
                    print_share(sum / hidden)});
  }
  if (has_names) {
    rows[0].insert(rows[0].begin() + 1, "name");
    for (std::size_t i = 0; i < chosen.size(); ++i)
      rows[i + 1].insert(rows[i + 1].begin() + 1, visible(tried[chosen[i].index].name));
  }
  std::cout << "\n" << print_table(rows) << "\n";
}

std::string why_no_hidden(const Scene& scene) {
  const auto is_hole = [](const ExplainedLoop& loop) { return loop.kind == LoopKind::kHole; };
  const auto holes = static_cast<std::size_t>(std::ranges::count_if(scene.loops.measures, is_hole));
  if (holes == 0) return "the results have no hole";
  return "the causes of all holes, " + print_count(holes) +
         ", are other ones than hidden and out of view, such as openings; holes.json has them";
}

// `spacing`: of the sample.
std::string why_no_floor(const HiddenScan& scan, const FloorLimits& floor, double spacing,
                         const std::string& unit) {
  std::array<std::size_t, 3> level{};  // points whose normals are along x, y and z
  for (const Eigen::Vector3f& normal : scan.normals)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      if (std::fabs(normal[axis]) >= kLevelFloor) ++level[static_cast<std::size_t>(axis)];
  const std::size_t up = level[1] >= level[0] ? 1 : 0;
  constexpr const char* kWayOut = "; --places states places of the scanner";
  const std::string counted = print_count(level[2]) + " points of the sample are level";
  if (level[up] > level[2])
    return counted + ", and " + print_count(level[up]) + " would be if " + "xy"[up] +
           " were up; z must be up: turn the scan, or state places of the scanner by --places";
  if (level[2] == 0) return "no points of the sample are level, so it has no floor" + std::string(kWayOut);
  if (kVoxel * spacing > kFreeFrom * floor.height)
    return counted + ", but points are " + print_length(spacing, unit) +
           " apart, too sparse to show free space below " + print_length(floor.height, unit) +
           "; a denser scan or sample (--sample-points of detect) shows it" + kWayOut;
  return counted + ", but none of the lowest has free space up to " + print_length(floor.height, unit) +
         " above it; --height states a lower scanner" + kWayOut;
}

std::string why_none_sees(std::span<const InnerSample> hidden, std::span<const Eigen::Vector3d> eyes,
                          const SightLimits& limits, const std::string& unit) {
  bool is_any_near = false, is_any_steep = false;
  for (const Eigen::Vector3d& eye : eyes) {
    for (const InnerSample& place : hidden) {
      const Eigen::Vector3d arm = place.position - eye;
      const bool is_near = arm.norm() <= limits.range;
      is_any_near |= is_near;
      is_any_steep |= is_near && std::fabs(arm.dot(place.normal)) >= limits.least_cosine * arm.norm();
    }
  }
  const std::string none = "none of the " + print_count(eyes.size()) + " places sees a hundredth of it: ";
  if (!is_any_near)
    return none + "all is farther than " + print_length(limits.range, unit) +
           "; --range states how far it measures";
  if (!is_any_steep) return none + "rays come at too small an angle; --incidence states the least";
  return none + "points of the scan stand in the way; --places or --height states other places";
}

// Warns where z is not up, where lengths have no unit, and where no cause says what is hidden.
void warn_of_assumptions(const StationsArguments& arguments, const Scene& scene, const HiddenScan& scan,
                         const SightLimits& limits) {
  const double area = scene.holes.at("surface_area").get<double>();
  const auto upward = arguments.places ? std::nullopt : other_upward(scan.points, scan.normals, area);
  if (upward) spdlog::warn(upward_warning(*upward));
  const bool is_height_assumed = arguments.height == 0 && !arguments.places;
  const bool is_range_assumed = arguments.range == 0 && limits.range == kRange;
  std::string assumed = is_height_assumed ? "the height of 1.6" : "";
  if (is_range_assumed) assumed += std::string(assumed.empty() ? "" : " and ") + "the range of 30";
  if (scene.holes.at("unit").get<std::string>().empty() && !assumed.empty())
    spdlog::warn(
        "no unit is known, so these are lengths of the scan: {}; --height and --range state others, or "
        "--unit of "
        "detect the unit",
        assumed);
  if (!scan.has_causes && !scan.hidden.empty())
    spdlog::warn(
        "no cause of a hole is known, as without stations of the scan: all holes count, also openings such "
        "as "
        "the sky; --stations of detect states them");
}

void run_stations(const StationsArguments& arguments) {
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const fs::path file = arguments.folder / kNextStationsFile;
  check_output(file, kNextStationsMark, overwrite);
  std::vector<ListedPosition> places;
  if (arguments.places) places = read_places(*arguments.places);
  const Scene scene = read_scene(arguments.folder);
  if (scene.points.positions.empty())
    throw Error(
        arguments.folder.string() +
        ": has no sample.ply, which rays are checked against; a run without --sample-points 0 writes it");
  HiddenScan scan = hidden_in(scene);
  thin(scan.hidden);
  const std::string unit = scene.holes.at("unit").get<std::string>();
  const double metre = 1 / metres_of_unit(unit).value_or(1);  // lengths without a unit count as metres
  const double least_length = 1e-4 * scene.edge;              // of voxels and grids: finer ones take too long
  if (arguments.grid != 0 && !(arguments.grid >= least_length))
    throw UsageError("--grid: must be 0, or " + print_length(least_length, unit) + " or more");
  const auto spacing = static_cast<double>(scene.points.spacing);
  const Obstacles obstacles(scan.points, std::max(kVoxel * spacing, least_length));
  const FloorLimits floor{.height = arguments.height > 0 ? arguments.height : kHeight * metre,
                          .grid = arguments.grid,
                          .clearance = 0.3 * metre};
  const double farthest = farthest_of(scene.holes.value("stations", Json::array()));
  const SightLimits limits{.range = arguments.range > 0 ? arguments.range
                                    : farthest > 0      ? farthest
                                                        : kRange * metre,
                           .least_cosine = std::sin(arguments.incidence * std::numbers::pi / 180)};
  warn_of_assumptions(arguments, scene, scan, limits);
  std::vector<Eigen::Vector3d> eyes;
  if (!arguments.places) {
    eyes = eyes_over_floor(scan.points, scan.normals, obstacles, floor);
    for (const Eigen::Vector3d& eye : eyes) places.push_back({.name = "", .position = eye});
  } else {
    for (const ListedPosition& place : places) eyes.push_back(place.position);
  }
  const std::vector<NextStation> chosen =
      choose_stations(scan.hidden, eyes, obstacles, limits, arguments.count);
  write_places(file, overwrite, scene, chosen, places, scan.area);

  std::cout << (scan.has_causes ? "hidden: " : "within holes: ") << print_area(scan.area, unit) << "; "
            << print_count(eyes.size()) << " places "
            << (arguments.places ? "of " + visible(arguments.places->string()) : "on the floor")
            << " were tried\n";
  if (chosen.empty())
    spdlog::warn("no next station: {}", scan.hidden.empty() ? why_no_hidden(scene)
                                        : eyes.empty()      ? why_no_floor(scan, floor, spacing, unit)
                                                            : why_none_sees(scan.hidden, eyes, limits, unit));
  else
    print_places(scene, chosen, places, scan.area, unit);
  std::cout << "written: " << visible(file.string()) << "\n";
}

}  // namespace

void add_stations_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("stations", "Say where a scanner should stand next, to see what is hidden");
  const auto arguments = std::make_shared<StationsArguments>();
  add_results_folder(command, arguments->folder);
  command.add_option("--count", arguments->count, "How many places at most")
      ->check(whole_number(1, 1000))
      ->capture_default_str();
  const auto length = [&](const char* name, double& value, const char* help) {
    return command.add_option(name, value, help)
        ->check(real_number())
        ->type_name("LENGTH")
        ->capture_default_str();
  };
  CLI::Option* const height = length("--height", arguments->height,
                                     "Height of the scanner over the floor, in units of the scan; 0: 1.6 m");
  length("--range", arguments->range, "How far it measures; 0: as far as the scan's stations, else 30 m");
  CLI::Option* const grid =
      length("--grid", arguments->grid, "Distance of the places that are tried; 0: as many as take seconds");
  command
      .add_option("--places", arguments->places,
                  "File with the places of the scanner to try, instead of those over the floor: x y z or "
                  "name x y z on each line")
      ->type_name("FILE")
      ->excludes(height)
      ->excludes(grid);
  command.add_option("--incidence", arguments->incidence, "Degrees between a ray and a surface, at least")
      ->check(real_number())
      ->type_name("DEGREES")
      ->capture_default_str();
  command.add_flag("--overwrite", arguments->overwrite, "Replace a file that Lacuna did not write, too");
  command.callback([arguments] { run_stations(*arguments); });
}

}  // namespace lacuna::tools
