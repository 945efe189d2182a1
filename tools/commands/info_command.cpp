// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config.hpp"
#include "engine/inspect.hpp"
#include "engine/run/machine.hpp"
#include "engine/run/parallel.hpp"
#include "io/explain/stations/station_views.hpp"
#include "io/read/files/number.hpp"
#include "io/read/formats.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/rows/scan_reader.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/write/loops/json.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/run_program.hpp"
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

struct InfoArguments {
  explicit InfoArguments(CLI::App& command) : parameters(command, parameters_of_info()) {}

  std::vector<fs::path> scans;
  bool json = false;
  ParameterOptions parameters;
};

struct AttributeCounts {
  std::uint64_t rows = 0;
  std::map<int, std::uint64_t> classes;  // empty if the file has no property classification
  bool has_returns = false;
  std::uint64_t only = 0, first = 0, later = 0;  // of pulses with one return, and with several
};

// ASPRS LAS 1.4 R15, table 17.
std::string_view name_of_class(int number) {
  constexpr std::string_view kNames[] = {"never classified",
                                         "unclassified",
                                         "ground",
                                         "low vegetation",
                                         "medium vegetation",
                                         "high vegetation",
                                         "building",
                                         "low point",
                                         "",
                                         "water",
                                         "rail",
                                         "road",
                                         "",
                                         "wire guard",
                                         "wire conductor",
                                         "transmission tower",
                                         "wire connector",
                                         "bridge deck",
                                         "high noise"};
  const bool is_known = number >= 0 && number < std::ssize(kNames);
  return is_known ? kNames[number] : std::string_view();
}

// Counts the points of a file by class and kind of return.
AttributeCounts count_attributes(ScanReader& reader, std::size_t rows_at_a_time) {
  AttributeCounts counts;
  const RowLayout& layout = reader.layout();
  const Property* const class_of = layout.find("classification");
  const Property* const number = layout.find("return_number");
  const Property* const number_of = layout.find("number_of_returns");
  counts.has_returns = number != nullptr && number_of != nullptr;
  std::vector<double> values, more;
  for (RowBatch rows; reader.next(rows, rows_at_a_time);) {
    counts.rows += rows.count;
    if (class_of != nullptr) {
      load_column(rows, layout.stride, *class_of, values);
      for (const double value : values) {
        if (std::abs(value) <= std::numeric_limits<int>::max()) ++counts.classes[static_cast<int>(value)];
      }
    }
    if (!counts.has_returns) continue;
    load_column(rows, layout.stride, *number, values);
    load_column(rows, layout.stride, *number_of, more);
    for (std::size_t i = 0; i < values.size(); ++i)
      ++(more[i] <= 1 ? counts.only : values[i] <= 1 ? counts.first : counts.later);
  }
  return counts;
}

// Returns "2 ground 83,412 · 5 high vegetation 20,110", by class.
std::string print_classes(const AttributeCounts& counts) {
  std::string text;
  for (const auto& [number, count] : counts.classes) {
    const std::string_view name = name_of_class(number);
    text += (text.empty() ? "" : " · ") + std::to_string(number) + (name.empty() ? "" : " ") +
            std::string(name) + " " + print_count(count);
  }
  return text;
}

std::string print_returns(const AttributeCounts& counts) {
  return print_count(counts.only) + " only, " + print_count(counts.first) + " first of several, " +
         print_count(counts.later) + " later";
}

struct FileInfo {
  fs::path file;
  std::string format;
  std::string crs, unit;
  bool is_geographic = false;
  RowLayout layout;
  AttributeCounts counts;
};

struct RunInfo {
  Inspection inspection;
  std::vector<StationSummary> stations;
  PointsOfNone points_of_none;
  ScanCounts counts;
  std::uint64_t stations_bytes = 0;
};

// What a run takes for each point (measured: docs/usage.md). An even scan with default options takes the
// least, a rough one with little memory and all results the most.
struct Need {
  double least, most;

  Need times(double count) const { return {least * count, most * count}; }
};
constexpr Need kTemporaryBytes{40, 800};
constexpr Need kKeptBytes{90, 600};   // more, with --workspace
constexpr Need kMicroseconds{1, 20};  // of processor time

struct Needs {
  Need temporary, kept, seconds;
};

Needs needs_of(const Summary& summary) {
  const auto points = static_cast<double>(summary.counts.points);
  return {.temporary = kTemporaryBytes.times(points),
          .kept = kKeptBytes.times(points),
          .seconds = kMicroseconds.times(1e-6 * points / static_cast<double>(summary.threads))};
}

std::string print_sizes(const Need& bytes) {
  return print_size(static_cast<std::uint64_t>(bytes.least)) + " to " +
         print_size(static_cast<std::uint64_t>(bytes.most));
}

// Avoids a pass over the file if its head has all numbers.
AttributeCounts counts_of_file(ScanReader& reader, std::size_t rows_at_a_time) {
  const RowLayout& layout = reader.layout();
  const bool has_attributes =
      layout.find("classification") != nullptr || layout.find("return_number") != nullptr;
  if (const auto expected = reader.expected_rows(); expected && !has_attributes) return {.rows = *expected};
  return count_attributes(reader, rows_at_a_time);
}

FileInfo read_file_info(const ScanFiles& scan, std::size_t file, const ReadOptions& options) {
  const std::unique_ptr<ScanReader> reader =
      open_scan(*scan.files()[file].format, scan.files()[file].name, options);
  return {.file = scan.files()[file].name,
          .format = reader->format(),
          .crs = reader->crs(),
          .unit = reader->length_unit(),
          .is_geographic = scan.files()[file].is_geographic,
          .layout = reader->layout(),
          .counts = counts_of_file(*reader, scan.batch_rows(file))};
}

RunInfo inspect_run(const ScanFiles& scan, const FilesConfig& config) {
  RunInfo run;
  NoProgress silence;
  const ScratchFolder scratch(temporary_parent(config.run.scratch));
  const auto stations = watch_stations(scan, config.output, scratch.path(), Ranges::kNone);
  ScanPass pass(scan, stations.get());
  run.inspection = inspect(pass, config, scratch.path(), silence);
  run.counts = pass.counts();
  if (stations) {
    const TaskArena arena(static_cast<std::size_t>(config.run.threads));
    stations->complete(arena);
    run.stations = stations->summaries();
    run.points_of_none = stations->points_of_none();
    run.stations_bytes = stations->disk_bytes();
  }
  return run;
}

std::string print_stations(const std::vector<StationSummary>& stations, std::string_view unit) {
  const auto degrees = [](double radians) { return print_area(radians * 180 / std::numbers::pi, "") + "°"; };
  std::vector<std::vector<std::string>> rows = {
      {"stations", "place", "points", "elevations", "turn", "farthest"}};
  for (const StationSummary& station : stations) {
    const bool moved = station.path > 0;
    rows.push_back({visible(station.name),
                    moved ? "moved " + print_length(station.path, unit) : print_point(station.place),
                    print_count(station.points),
                    degrees(std::asin(station.lowest)) + " to " + degrees(std::asin(station.highest)),
                    degrees(2 * std::numbers::pi * station.turn), print_length(station.farthest, unit)});
  }
  return print_table(rows);
}

void print_text(const std::vector<FileInfo>& files, const ScanFiles& scan, const RunInfo& run) {
  for (const FileInfo& file : files) {
    std::cout << visible(file.file.string()) << "\n  format      " << file.format << "\n  points      "
              << print_count(file.counts.rows);
    if (!file.counts.classes.empty()) std::cout << "\n  classes     " << print_classes(file.counts);
    if (file.counts.has_returns) std::cout << "\n  returns     " << print_returns(file.counts);
    if (!file.crs.empty()) std::cout << "\n  crs         " << crs_name(file.crs);
    if (file.is_geographic) std::cout << "\n  unit        degrees, which lacuna detect refuses";
    if (!file.unit.empty()) std::cout << "\n  unit        " << file.unit;
    std::cout << "\n  properties ";
    for (const Property& property : file.layout.properties) {
      std::cout << " " << property.name << " (" << ply_name(property.type) << ")";
    }
    std::cout << "\n";
  }
  if (!run.stations.empty()) std::cout << "\n" << print_stations(run.stations, scan.length_unit());
  const Summary& summary = run.inspection.summary;
  const Needs needs = needs_of(summary);
  std::cout << "\na run of lacuna detect\n  points        " << print_count(summary.counts.points);
  std::cout << print_left_out(summary.counts, run.counts.filtered_out);
  if (!scan.common_crs().empty()) std::cout << "\n  crs           " << crs_name(scan.common_crs());
  if (!scan.length_unit().empty()) std::cout << "\n  unit          " << scan.length_unit();
  const auto is_other = [](const ScanFile& file) { return !file.z_unit.empty(); };
  if (const auto z = std::ranges::find_if(scan.files(), is_other); z != scan.files().end())
    std::cout << ", with z in " << z->z_unit << " in the files, which is brought into it";
  if (summary.resolution > 0) {
    std::cout << "\n  resolution    " << summary.resolution << ": "
              << print_count(summary.counts.points - summary.counts.dropped - summary.counts.thinned_out)
              << " points are used, one per cell";
  }
  std::cout << "\n  bounds        ";
  if (summary.bounds.isEmpty()) {
    std::cout << "none: no finite point";
  } else {
    std::cout << print_point(summary.bounds.min()) << " to " << print_point(summary.bounds.max());
  }
  std::cout << "\n  tiles         " << print_count(summary.tiles) << ", of at most "
            << print_count(summary.tile_points) << " points"
            << "\n  cells         " << print_count(run.inspection.cells) << ", of size "
            << run.inspection.cell_size << "\n  memory limit  " << print_size(summary.memory_limit)
            << "\n  threads       " << summary.threads << "\n  disk          " << print_sizes(needs.temporary)
            << " in temporary files, and the results\n  kept folder   " << print_sizes(needs.kept)
            << " more, with --workspace\n  time          " << print_duration(needs.seconds.least) << " to "
            << print_duration(needs.seconds.most) << "\n";
  if (!run.stations.empty())
    std::cout << "  stations      " << print_size(run.stations_bytes)
              << " more on disk, where causes of holes are found\n";
}

Json returns_of(const AttributeCounts& counts) {
  if (!counts.has_returns) return {};
  return {{"only", counts.only}, {"first", counts.first}, {"later", counts.later}};
}

std::string json_of(const std::vector<FileInfo>& files, const ScanFiles& scan, const RunInfo& run) {
  Json root;
  root["files"] = Json::array();
  for (const FileInfo& file : files) {
    Json properties = Json::array();
    for (const Property& property : file.layout.properties) {
      properties.push_back({{"name", property.name}, {"type", ply_name(property.type)}});
    }
    Json classes = Json::object();
    for (const auto& [number, count] : file.counts.classes) classes[std::to_string(number)] = count;
    root["files"].push_back({{"file", file.file.string()},
                             {"format", file.format},
                             {"points", file.counts.rows},
                             {"classes", std::move(classes)},
                             {"returns", returns_of(file.counts)},
                             {"crs", file.crs.empty() ? Json() : Json(file.crs)},
                             {"unit", file.is_geographic ? "degree" : file.unit},
                             {"properties", std::move(properties)}});
  }
  const Summary& summary = run.inspection.summary;
  put_crs(scan, root);
  root["points"] = summary.counts.points;
  root["dropped"] = summary.counts.dropped - run.counts.filtered_out.total();
  root["filtered_out"] = counts_of(run.counts.filtered_out);
  root["bounds"] = corners(summary.bounds);
  root["strays"] = strays_json(summary.strays);
  root["resolution"] = summary.resolution;
  root["thinned_out"] = summary.counts.thinned_out;
  root["stations"] = stations_json(run.stations);
  root["tiles"] = summary.tiles;
  root["tile_points"] = summary.tile_points;
  root["cells"] = run.inspection.cells;
  root["cell_size"] = run.inspection.cell_size;
  root["memory_limit"] = summary.memory_limit;
  root["threads"] = summary.threads;
  const Needs needs = needs_of(summary);
  const auto need_json = [](const Need& need) { return Json{{"least", need.least}, {"most", need.most}}; };
  root["temporary_bytes"] = need_json(needs.temporary);
  root["kept_bytes"] = need_json(needs.kept);
  root["stations_bytes"] = run.stations_bytes;
  root["seconds"] = need_json(needs.seconds);
  return print(root, 2) + "\n";
}

// All that is known of a scan before its run.
struct ScanInfo {
  ScanInfo(const std::vector<fs::path>& scans, const FilesConfig& config)
      : scan(expand_inputs(scans, config), config.input, read_options(config).memory) {
    for (std::size_t i = 0; i < scan.files().size(); ++i)
      files.push_back(read_file_info(scan, i, read_options(config)));
    run = inspect_run(scan, config);
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> all = input_warnings(scan);
    const Summary& summary = run.inspection.summary;
    std::ranges::copy(filter_warnings(scan, run.counts, summary.strays.rest), std::back_inserter(all));
    if (std::string strays = stray_warning(summary.strays, summary.resolution); !strays.empty())
      all.push_back(std::move(strays));
    std::ranges::copy(station_warnings(run.stations, run.points_of_none), std::back_inserter(all));
    return all;
  }

  ScanFiles scan;
  std::vector<FileInfo> files;
  RunInfo run;
};

void run_info(const InfoArguments& arguments) {
  const FilesConfig config = arguments.parameters.start();
  const ScanInfo info(arguments.scans, config);
  if (arguments.json) {
    std::cout << json_of(info.files, info.scan, info.run);
  } else {
    print_text(info.files, info.scan, info.run);
  }
  print_warnings(info.warnings());
}

}  // namespace

std::string info_json(const std::vector<fs::path>& scans, const FilesConfig& config,
                      std::vector<std::string>& warnings) {
  const ScanInfo info(scans, config);
  warnings = info.warnings();
  return json_of(info.files, info.scan, info.run);
}

void add_info_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("info", "Show what scan files hold and what a run on them would take");
  const auto arguments = std::make_shared<InfoArguments>(command);
  add_scans(command, arguments->scans)->required();
  command.add_flag("--json", arguments->json, "Print the same as JSON, for programs");
  command.callback([arguments] { run_info(*arguments); });
}

}  // namespace lacuna::tools
