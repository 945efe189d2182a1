// SPDX-License-Identifier: Apache-2.0
#include "io/report/report.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

namespace lacuna::tools {
using namespace io;

namespace {

struct ReportArguments {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> marks;
  bool overwrite = false;
};

void print_matches(const MatchedMarks& marks) {
  const auto& [by, by_id, by_place] = marks.matches;
  std::cout << "marks: " << by_id + by_place << " of " << by.size() << " found their loops, " << by_id
            << " by id and " << by_place << " by place\n";
  for (std::size_t i = 0; i < by.size(); ++i) {
    if (by[i]) continue;
    const LoopMark& mark = marks.marks[i];
    std::cout << "no loop fits: " << mark.mark << ", " << name_of(mark.kind) << " " << mark.id << " at "
              << print_place(mark.centroid, mark.diameter) << ", diameter " << print_length(mark.diameter, "")
              << "\n";
  }
}

void run_report(const ReportArguments& arguments) {
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const WrittenReport report = write_report(arguments.folder, overwrite, arguments.marks);
  std::cout << "written: " << visible(report.file.string()) << "\n";
  if (arguments.marks) print_matches(report.marks);
}

}  // namespace

void add_report_command(const Command& program) {
  const Command command = program.add_command(
      "report", "Write report.html, the scan and its holes in 3D, for the results in a folder");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("DIR", arguments->folder, "Folder with the results of lacuna detect")
      .type("DIR")
      .required();
  command.add_flag("--overwrite", arguments->overwrite,
                   "Replace a report.html that Lacuna did not write, too");
  command
      .add_option("--marks", arguments->marks,
                  "File of marks that the report starts with, as Save marks of a report writes it")
      .type("FILE");
  command.runs([arguments] { run_report(*arguments); });
}

}  // namespace lacuna::tools
