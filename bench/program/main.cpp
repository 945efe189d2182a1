// SPDX-License-Identifier: Apache-2.0
// The program `lacuna-bench`: a benchmark for programs that find holes.
#include "bench/program/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/run/run_program.hpp"

[[gnu::section(".preinit_array"), gnu::used]] static auto* first = lacuna::tools::check_limits;

int main(int argc, char** argv) {
  using namespace lacuna;
  tools::CommandLine line("lacuna-bench",
                          "Makes scans with known holes, and evaluates what programs find in them.",
                          "lacuna-bench " LACUNA_VERSION);
  bench::add_synth_command(line.program());
  bench::add_evaluate_command(line.program());
  bench::add_make_command(line.program());
  bench::add_score_command(line.program());
  return tools::run_program("lacuna-bench", line, argc, argv);
}
