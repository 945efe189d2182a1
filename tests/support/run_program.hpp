// SPDX-License-Identifier: Apache-2.0
// Runs `lacuna` and `lacuna-bench` as a user would, and catches what they print.
#pragma once

#include "tests/support/scratch_folder.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
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

// Runs `lacuna detect SCAN --out OUT --quiet` with more options, and requires that it succeeds. Returns
// `out`.
std::filesystem::path detect(const std::string& scan, const std::filesystem::path& out,
                             const Words& options = {});

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
void check_same_results(const std::filesystem::path& folder, const std::filesystem::path& expected);

// The content of a result in JSON.
nlohmann::json read_json(const std::filesystem::path& file);

// The text of an element of a report's page that is a script.
std::string element(const std::string& page, const std::string& id);

}  // namespace lacuna::test
