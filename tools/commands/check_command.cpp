// SPDX-License-Identifier: Apache-2.0
// `lacuna check`: whether a scan covers an area. It reads the scan once and finds no loops.
#include "io/explain/area/check_area.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/write/results/voids.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/detect_command.hpp"
#include "tools/commands/summary.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/folders.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/run_program.hpp"
#include "tools/run/scan_warnings.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

struct CheckArguments {
  explicit CheckArguments(const Command& command) : run(command, parameters_of_check()) {}

  std::vector<std::filesystem::path> scans;
  ResultArguments run;
};

// Throws `AnswerIsNo` unless the scan covers the area, so that scripts see it.
void run_check(const CheckArguments& arguments) {
  FilesConfig base;
  base.area.is_check = true;
  const FilesConfig config = arguments.run.start(std::move(base));
  if (config.area.area_tile > 0 && arguments.run.out.empty())
    spdlog::warn("--area-tile changes nothing without --out");
  if (config.output.report && arguments.run.out.empty())
    spdlog::warn("--report changes nothing without --out");
  const ScanFiles scan = open_inputs(expand_inputs(arguments.scans, config), config);
  std::optional<OutFolder> out;
  if (!arguments.run.out.empty()) {
    out.emplace(arguments.run.out, kVoidsFile);
    check_not_input(out->results(), scan);
  }
  const std::unique_ptr<Progress> progress = arguments.run.show_progress();
  const AreaCheck check = check_scan(scan, config, *progress);
  print_warnings(area_warnings(check, scan.length_unit()));
  Eigen::AlignedBox3d bounds;
  for (const AreaPolygon& polygon : check.polygons)
    for (const Eigen::Vector2d& corner : polygon.outline.front())
      bounds.extend(Eigen::Vector3d(corner.x(), corner.y(), 0));
  print_warnings(filter_warnings(scan, check.counts, bounds));
  const std::string_view unit = scan.length_unit();
  const std::string answer = print_answer(check, unit);
  std::string text = answer + "\n\n";
  if (const std::string voids = print_voids(check, unit); !voids.empty()) text += voids + "\n";
  text += "  area  " + print_covered(check, unit) + "\n" + print_classes(check, unit) + "\n" +
          print_basis(check) + "\n";
  if (out) {
    for (const auto& file : write_voids(check, scan, config, out->results()))
      text += "written: " + visible(file.string()) + "\n";
    note_complete_results();
  }
  if (!arguments.run.quiet) std::cout << text;
  if (!check.is_covered())
    throw AnswerIsNo{(check.is_outline ? "outline of the scan" : config.area.area) + ": " + answer,
                     check.answer() == AreaAnswer::kVoids};
}

}  // namespace

void add_check_command(const Command& program) {
  const Command command =
      program.add_command("check", "Check whether a scan covers an area, without finding its loops");
  const auto arguments = std::make_shared<CheckArguments>(command);
  add_scans(command, arguments->scans).required();
  command.option("--report")
      .help("Write report.html too: one sheet with the answer and a map, for acceptance.");
  command.runs([arguments] { run_check(*arguments); });
}

}  // namespace lacuna::tools
