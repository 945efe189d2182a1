// Runs the program `lacuna` as a user would, and catches what it says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lacuna::test {

struct ProgramResult {
  int exit_code = 0;  // 128 + n: killed by signal n
  std::string out;
  std::string err;
  std::uint64_t peak_memory = 0;  // bytes resident at most, looked at every millisecond
};

ProgramResult run_program(const std::vector<std::string>& arguments);

// Any command, searched for in PATH; exit code 126 if there is none.
ProgramResult run_command(const std::vector<std::string>& words);

// Sends `signal` as soon as `moment` returns true; without it, if the program ends first.
ProgramResult run_program_until(const std::vector<std::string>& arguments, int signal,
                                const std::function<bool()>& moment);

// A folder of its own for a test, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, const std::string& content) const;  // its path

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& file);
std::size_t count_lines(const std::string& text);

}  // namespace lacuna::test
