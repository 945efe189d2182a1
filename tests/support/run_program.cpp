// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lacuna::test {
namespace {

void redirect(const fs::path& file, int descriptor) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(125);
}

// The peak memory of a running process. Not wait4's ru_maxrss: that counts what the forked child held before
// it became the program, which is all that these tests hold.
std::uint64_t peak_resident(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  }
  return 0;
}

ProgramResult run(std::vector<std::string> words, const std::function<void(pid_t)>& meanwhile) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  const fs::path err = scratch / "err";
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(126);
  }

  int status = 0;
  std::uint64_t peak = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    // The last look counts: an early one may see the child before it is the program.
    if (const std::uint64_t resident = peak_resident(child)) peak = resident;
    meanwhile(child);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const int exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {exit_code, read_file(out), read_file(err), peak};
}

}  // namespace

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

ProgramResult run_program(const Words& arguments, Program program) {
  return run_program_beside(
      arguments, [](pid_t) {}, program);
}

ProgramResult run_bench(const Words& arguments) {
  return run_program(arguments, Program::kBench);
}

ProgramResult succeed(const Words& arguments, Program program) {
  const ProgramResult result = run_program(arguments, program);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  return result;
}

fs::path detect(const std::string& scan, const fs::path& out, const Words& options) {
  succeed(with({"detect", scan, "--out", out.string(), "--quiet"}, options));
  return out;
}

ProgramResult run_program_until(const Words& arguments, int signal, const std::function<bool()>& moment,
                                Program program) {
  bool sent = false;
  const auto send = [&](pid_t process) {
    if (sent || !moment()) return;
    kill(process, signal);
    sent = true;
  };
  return run_program_beside(arguments, send, program);
}

ProgramResult run_program_beside(const Words& arguments, const std::function<void(pid_t)>& meanwhile,
                                 Program program) {
  return run(with({program == Program::kBench ? LACUNA_BENCH_PROGRAM : LACUNA_PROGRAM}, arguments),
             meanwhile);
}

std::string synth(const std::string& kind, const fs::path& file, const Words& options) {
  succeed(with({"synth", kind, file.string()}, options), Program::kBench);
  return file.string();
}

ProgramResult run_command(const Words& words) {
  return run(words, [](pid_t) {});
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void check_failure(const ProgramResult& result, int exit_code, const std::string& named) {
  INFO(result.err);
  CHECK(result.exit_code == exit_code);
  CHECK(result.out.empty());
  CHECK_THAT(result.err, StartsWith("lacuna: error: ") || StartsWith("lacuna-bench: error: "));
  CHECK_THAT(result.err, Contains(named));
  CHECK(count_lines(result.err) == 1);
}

void check_same_results(const fs::path& folder, const fs::path& expected) {
  for (const char* name : {"holes.json", "holes.csv", "loops.ply", "boundary.ply", "sample.ply"})
    CHECK(fs::exists(expected / name));
  for (const auto& entry : fs::recursive_directory_iterator(expected)) {
    const fs::path name = entry.path().lexically_relative(expected);
    if (name == "run.json" || !entry.is_regular_file()) continue;
    INFO(name);
    CHECK((read_file(folder / name) == read_file(entry.path())));
  }
}

std::string element(const std::string& page, const std::string& id) {
  const std::string begin = "id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  REQUIRE(at != page.npos);
  return page.substr(at + begin.size(), page.find("</script>", at) - at - begin.size());
}

}  // namespace lacuna::test
