// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/stations/find_station.hpp"
#include "io/stations/list_lines.hpp"
#include "io/stations/station_views.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/detect_command.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/folders.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/parameter_options.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

struct FindArguments {
  // Rays without return interrupt a line, whether they are dropped or at 0 0 0.
  explicit FindArguments(const Command& command)
      : parameters(command, {.common = {"bounds", "where", "memory_limit"},
                             .rare = {"columns", "leave_out", "keep_withheld", "keep_noise", "trust", "crs",
                                      "unit", "unit_z", "recursive", "skip_damaged", "threads", "scratch"}}) {
  }

  std::vector<fs::path> scans;
  ParameterOptions parameters;
};

// A station of the list, with the line that --stations reads.
struct Listed {
  std::string line, subject;
  double share = 0, certainty = 0;
};

// These characters may not be in a field of a list: they end a field or a line, or begin a comment.
bool divides(char c) {
  return kFieldDivisors.find(c) != kFieldDivisors.npos || c == '\n' || c == '#';
}

std::string without_divisors(std::string name) {
  std::replace_if(name.begin(), name.end(), divides, '_');
  return name;
}

// Returns the last part of the file's name alone, if no other file has it.
std::string name_in_list(std::size_t file, const ScanFiles& scan) {
  const fs::path last = scan.files()[file].name.filename();
  const auto same = std::ranges::count_if(
      scan.files(), [&](const ScanFile& other) { return other.name.filename() == last; });
  return same == 1 ? last.string() : scan.files()[file].name.string();
}

// Returns the subject of the sweep: the file, and the number.
std::string subject_of(const Sweep& sweep, const ScanFiles& scan) {
  const std::string number = sweep.source ? " " + std::to_string(*sweep.source) : "";
  return scan.files()[sweep.file].name.string() + number;
}

Listed listed(const Sweep& sweep, const FoundStation& found, const ScanFiles& scan) {
  const fs::path& file = scan.files()[sweep.file].name;
  const std::string source = sweep.source ? std::to_string(*sweep.source) : "";
  Listed station{.line = without_divisors(file.stem().string()) + (source.empty() ? "" : "_" + source),
                 .subject = subject_of(sweep, scan),
                 .share = found.share};
  for (const double coordinate : found.place)
    station.line += fmt::format(" {:.4f}", std::round(1e4 * coordinate) / 1e4 + 0.0);
  station.line += " " + name_in_list(sweep.file, scan) + (source.empty() ? "" : " " + source);
  return station;
}

// Finds shares of points that can have been measured from the stations, by their lines.
void find_certainties(std::vector<Listed>& stations, const ScanFiles& scan, const RunConfig& run) {
  const ScratchFolder scratch(temporary_parent(run.scratch));
  const fs::path list = scratch.path() / "stations.txt";
  std::ofstream out(list);
  for (const Listed& station : stations) out << station.line << "\n";
  out.close();
  if (!out) throw Error(list.string() + ": cannot be written");
  StationViews views(scan, list, scratch.path());
  views.complete(TaskArena(static_cast<std::size_t>(run.threads)));
  const std::vector<StationSummary> summaries = views.summaries();
  for (std::size_t i = 0; i < stations.size(); ++i) stations[i].certainty = summaries[i].certainty;
}

void run_find_stations(const FindArguments& arguments) {
  const FilesConfig config = arguments.parameters.start();
  const ScanFiles scan = open_inputs(expand_inputs(arguments.scans, config), config);
  std::vector<Listed> stations;
  std::vector<std::string> others;
  for (const Sweep& sweep : read_sweeps(scan)) {
    const std::optional<FoundStation> found = find_station(sweep.jumps.jumps());
    if (!found) {
      others.push_back(subject_of(sweep, scan) + ": it has too few jumps in range");
    } else if (found->share < FoundStation::kLeastShare) {
      others.push_back(subject_of(sweep, scan) + ": its points are not in the order of one sweep");
    } else if (std::ranges::any_of(name_in_list(sweep.file, scan), divides)) {
      others.push_back(subject_of(sweep, scan) + ": a list cannot have this name, which is not one word");
    } else {
      stations.push_back(listed(sweep, *found, scan));
    }
  }
  if (!stations.empty()) find_certainties(stations, scan, config.run);
  std::string lines;
  for (const Listed& station : stations) {
    const std::string points =
        fmt::format("{:.2f} % of its points can have been seen from there", 100 * station.certainty);
    if (station.certainty < StationView::kLeastCertain) {
      others.push_back(station.subject + ": only " + points);
    } else {
      lines +=
          fmt::format("# {:.0f} % of the jumps agree; {}\n{}\n", 100 * station.share, points, station.line);
    }
  }
  if (lines.empty()) throw Error("no station was found: " + others.front());
  std::cout << "# Stations that lacuna find-stations found; lacuna detect --stations reads this list.\n"
               "# name x y z points\n"
            << lines;
  for (const std::string& other : others) std::cout << "# no station: " << visible(other) << "\n";
}

}  // namespace

void add_find_stations_command(const Command& program) {
  const Command command = program.add_command(
      "find-stations", "Find where scanners stood, from scans that are single sweeps in their order");
  const auto arguments = std::make_shared<FindArguments>(command);
  add_scans(command, arguments->scans).required();
  command.runs([arguments] { run_find_stations(*arguments); });
}

}  // namespace lacuna::tools
