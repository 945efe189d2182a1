// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/write/report/report.hpp"
#include "io/write/results/voids.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/folders.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

namespace lacuna::tools {
using namespace io;
namespace fs = std::filesystem;

namespace {

struct ReportArguments {
  std::filesystem::path folder;
  bool overwrite = false;
};

void run_report(const ReportArguments& arguments) {
  if (fs::exists(arguments.folder / kVoidsFile) && !fs::exists(arguments.folder / "holes.json"))
    throw Error(arguments.folder.string() +
                ": has the results of lacuna check, whose --report writes their sheet");
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const std::filesystem::path file = write_report(arguments.folder, overwrite);
  std::cout << "written: " << visible(file.string()) << "\n";
}

}  // namespace

void add_report_command(const Command& program) {
  const Command command = program.add_command(
      "report", "Write report.html, the scan and its holes in 3D, for the results in a folder");
  const auto arguments = std::make_shared<ReportArguments>();
  add_results_folder(command, arguments->folder);
  command.add_flag("--overwrite", arguments->overwrite,
                   "Replace a report.html that Lacuna did not write, too");
  command.runs([arguments] { run_report(*arguments); });
}

}  // namespace lacuna::tools
