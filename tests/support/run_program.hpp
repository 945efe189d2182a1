// SPDX-License-Identifier: Apache-2.0
// Runs `lacuna` and `lacuna-bench` as a user would, and catches what they print.
#pragma once

#include "tests/support/test.hpp"

#include <sys/types.h>

namespace lacuna::test {

struct ProgramResult {
  int exit_code = 0;  // 128 + n: killed by signal n
  std::string out;
  std::string err;
  std::uint64_t peak_memory = 0;  // bytes resident at most, looked at every millisecond
};

enum class Program { kLacuna, kBench };

using Words = std::vector<std::string>;

// `more` words behind the others.
Words with(Words words, const Words& more);

ProgramResult run_program(const Words& arguments, Program program = Program::kLacuna);
ProgramResult run_bench(const Words& arguments);  // lacuna-bench

// Requires that the program succeeds.
ProgramResult succeed(const Words& arguments, Program program = Program::kLacuna);

// Runs `lacuna detect SCAN --out OUT --quiet` with more options, and requires that it succeeds. Returns
// `out`.
fs::path detect(const std::string& scan, const fs::path& out, const Words& options = {});

// Runs `lacuna-bench synth KIND FILE`, of a surface or a scan, and requires that it succeeds. Returns `file`.
std::string synth(const std::string& kind, const fs::path& file, const Words& options = {});

// Any command, searched for in PATH; exit code 126 if there is none.
ProgramResult run_command(const Words& words);

// Sends `signal` as soon as `moment` returns true; without it, if the program ends first.
ProgramResult run_program_until(const Words& arguments, int signal, const std::function<bool()>& moment,
                                Program program = Program::kLacuna);

// Calls meanwhile(process) every millisecond until the program ends.
ProgramResult run_program_beside(const Words& arguments, const std::function<void(pid_t)>& meanwhile,
                                 Program program = Program::kLacuna);

std::size_t count_lines(const std::string& text);

// Checks that the program ended with this exit code, printed nothing on stdout, and one line of an error that
// has `named` on stderr.
void check_failure(const ProgramResult& result, int exit_code, const std::string& named);

// Checks that a folder has all files of the results in `expected`, with the same bytes. run.json may differ.
void check_same_results(const fs::path& folder, const fs::path& expected);

// The text of an element of a report's page that is a script.
std::string element(const std::string& page, const std::string& id);

// A flat, uneven sheet of n by n points with a square hole in its middle.
inline std::string sheet(int n) {
  std::ostringstream out;
  out << "x y z\n";
  const int from = n / 2 - n / 8;
  const int to = n / 2 + n / 8;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const bool in_hole = from <= i && i < to && from <= j && j < to;
      if (!in_hole) out << i + 0.1 * ((i * 7 + j * 3) % 5) << ' ' << j + 0.1 * ((i + j * 5) % 7) << " 0\n";
    }
  }
  return out.str();
}

}  // namespace lacuna::test
