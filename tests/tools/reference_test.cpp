// SPDX-License-Identifier: Apache-2.0
// The manual page and the completions have every command and every option.
#include "io/options/options.hpp"
#include "tests/support/run_program.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::tools {
namespace {

using Catch::Matchers::Contains;
using test::run_command;
using test::run_program;

std::string printed(const std::vector<std::string>& arguments) {
  const test::ProgramResult result = run_program(arguments);
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  return result.out;
}

// As troff has it: each hyphen behind a backslash.
std::string in_troff(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '-' ? "\\-" : std::string(1, c);
  return out;
}

bool is_installed(const std::string& program) {
  return run_command({"sh", "-c", "command -v " + program}).exit_code == 0;
}

TEST_CASE("the manual page has every parameter, its section and its default", "[reference]") {
  const std::string page = printed({"manual"});
  io::FilesConfig config;
  for (const Parameter& parameter : parameters(config)) {
    if (parameter.is_constant) continue;
    CHECK_THAT(page, Contains("\\fB" + in_troff(parameter.option()) + "\\fR") &&
                         Contains(".SS [" + std::string(parameter.section) + "]"));
  }
  for (const char* part : {"synth surface", "EXIT STATUS", "lacuna 0.1.0", "Default: 15", "\\fBpaper\\fR"})
    CHECK_THAT(page, Contains(part));
}

TEST_CASE("the manual page is correct troff, in lines that are short enough", "[reference]") {
  const test::ScratchFolder scratch;
  const std::string page = scratch.write("lacuna.1", printed({"manual"}));
  std::string line;
  for (const char c : test::read_file(page)) {
    line = c == '\n' ? "" : line + c;
    if (line.size() > 120) FAIL_CHECK("too long: " << line);
  }
  if (is_installed("mandoc")) CHECK(run_command({"mandoc", "-Tlint", "-Wwarning", page}).out.empty());
  if (is_installed("man")) CHECK(run_command({"man", "--warnings", "-l", page}).err.empty());
}

TEST_CASE("the date of the manual page may be given, so that its bytes are the same again", "[reference]") {
  const std::vector<std::string> words = {"env", "SOURCE_DATE_EPOCH=86400", LACUNA_PROGRAM, "manual"};
  CHECK_THAT(run_command(words).out, Contains(".TH LACUNA 1 1970-01-02 "));
}

TEST_CASE("every completion has every parameter and every choice", "[reference]") {
  io::FilesConfig config;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    INFO(shell);
    const std::string script = printed({"completion", shell});
    for (const Parameter& parameter : parameters(config)) {
      if (parameter.is_constant) continue;
      const std::string option = parameter.option();
      CHECK_THAT(script, Contains(shell == "fish" ? " -l " + option.substr(2) + " " : option));
    }
    for (const char* part : {"tangential paper", "bar plain json none", "sphere-cap", "surface", "laz"})
      CHECK_THAT(script, Contains(part));
    const test::ScratchFolder scratch;
    const std::string file = scratch.write("script", script);
    if (is_installed(shell)) CHECK(run_command({shell, "-n", file}).err.empty());
  }
  CHECK(run_program({"completion", "tcsh"}).exit_code == 2);
}

// What bash offers for the last of the words, separated by blanks.
std::string offered(const test::ScratchFolder& folder, const std::string& words) {
  const std::string script = folder.write("completion", printed({"completion", "bash"}));
  const std::string program = "cd '" + folder.path().string() + "'; source '" + script + "'; COMP_WORDS=(" +
                              words +
                              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _lacuna; "
                              "echo \"${COMPREPLY[*]}\"";
  const test::ProgramResult result = run_command({"bash", "-c", program});
  CHECK(result.err.empty());
  return result.out;
}

TEST_CASE("bash completes commands, options, choices, scans and folders", "[reference]") {
  const test::ScratchFolder folder;
  for (const char* name : {"scan.LAZ", "s.toml", "s.bin"}) folder.write(name, "");
  CHECK(offered(folder, "lacuna det") == "detect\n");
  CHECK(offered(folder, "lacuna synth ''") == "surface scan\n");
  CHECK(offered(folder, "lacuna detect --min-h") == "--min-hole\n");
  CHECK(offered(folder, "lacuna detect --method ''") == "tangential paper\n");
  CHECK(offered(folder, "lacuna detect --method = p") == "paper\n");
  CHECK(offered(folder, "lacuna detect s") == "scan.LAZ\n");
  CHECK(offered(folder, "lacuna detect --config s") == "s.toml\n");
  CHECK(offered(folder, "lacuna detect --k ''") == "\n");
  CHECK(offered(folder, "lacuna synth surface --kind c") == "cylinder cube\n");
}

}  // namespace
}  // namespace lacuna::tools
