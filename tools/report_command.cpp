// SPDX-License-Identifier: Apache-2.0
#include "tools/report_command.hpp"

#include "io/report/report.hpp"
#include "tools/visible_text.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
using namespace io;

namespace {

struct ReportArguments {
  std::filesystem::path folder;
  bool overwrite = false;
};

void run_report(const ReportArguments& arguments) {
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const std::filesystem::path file = write_report(arguments.folder, overwrite);
  std::cout << "written: " << visible(file.string()) << "\n";
}

}  // namespace

void add_report_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "report", "Write report.html, the scan and its holes in 3D, for the results in a folder");
  const auto arguments = std::make_shared<ReportArguments>();
  command->add_option("DIR", arguments->folder, "Folder with the results of lacuna detect")
      ->type_name("DIR")
      ->required();
  command->add_flag("--overwrite", arguments->overwrite,
                    "Replace a report.html that Lacuna did not write, too");
  command->callback([arguments] { run_report(*arguments); });
}

}  // namespace lacuna::tools
