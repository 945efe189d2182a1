// SPDX-License-Identifier: Apache-2.0
// The program `lacuna`: its commands.
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/run/run_program.hpp"

[[gnu::section(".preinit_array"), gnu::used]] static auto* first = lacuna::tools::check_limits;

int main(int argc, char** argv) {
  using namespace lacuna::tools;
  CommandLine line("lacuna", "Lacuna finds holes in scanned surfaces, also in scans larger than memory.",
                   "lacuna " LACUNA_VERSION);
  CLI::App& program = line.program();
  add_detect_command(program);
  add_info_command(program);
  add_check_command(program);
  add_report_command(program);
  add_render_command(program);
  add_compare_command(program);
  add_stations_command(program);
  add_plan_command(program);
  add_work_command(program);
  add_finish_command(program);
  add_status_command(program);
  add_clean_command(program);
  return run_program("lacuna", line, argc, argv);
}
