// SPDX-License-Identifier: Apache-2.0
// What the system, the terminal and other programs may do to a run.
#include "engine/store/temporary_folder.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/test.hpp"

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lacuna::test {
namespace {

// The program, run by a shell after `before`.
ProgramResult run_in_shell(const std::string& before, const Words& arguments,
                           const std::string& redirections = "") {
  const std::string script = before + "exec \"$0\" \"$@\" " + redirections;
  return run_command(with({"bash", "-c", script, LACUNA_PROGRAM}, arguments));
}

TEST_CASE("messages never go into a file, whichever standard descriptors are closed") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(60));
  const auto detect = [&](const std::string& out, const std::string& redirections) {
    return run_in_shell("",
                        {"detect", scan, "--points", "--points-format", "ply", "--out",
                         (scratch / out).string(), "--progress", "plain", "--tile-points", "500"},
                        redirections);
  };
  REQUIRE(detect("open", "").exit_code == 0);
  const std::string points = read_file(scratch / "open" / "points.ply");
  for (const std::string closed : {"2>&-", "<&- 2>&-", "<&- >&- 2>&-", "<&-"}) {
    INFO(closed);
    const ProgramResult result = detect("out" + closed, closed);
    CHECK(result.exit_code == (Contains(">&- ").match(closed) ? 1 : 0));  // without stdout, no summary
    CHECK(read_file(scratch / ("out" + closed) / "points.ply") == points);
    CHECK(count_entries(scratch / ("out" + closed)) == 7);
  }
}

TEST_CASE("a file over the size limit is an error, and the workspace is removed") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(150));
  const fs::path out = scratch / "out";
  check_failure(run_in_shell("ulimit -f 64; ", {"detect", scan, "--out", out.string(), "--quiet"}), 1,
                "File too large");
  CHECK_FALSE(fs::exists(out));
}

// A child whose stderr is a pipe that is full and that nobody reads.
class Blocked {
 public:
  explicit Blocked(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (pipe2(pipe_, O_CLOEXEC | O_NONBLOCK) != 0) throw std::runtime_error("cannot make a pipe");
    while (write(pipe_[1], "x", 1) == 1) {
    }
    fcntl(pipe_[1], F_SETFL, 0);  // the child waits
    child_ = fork();
    if (child_ != 0) return;
    dup2(pipe_[1], STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(126);
  }
  ~Blocked() {
    if (!exit_code_) kill(child_, SIGKILL);
    if (!exit_code_) waitpid(child_, nullptr, 0);
    for (const int end : pipe_) close(end);
  }
  void send(int signal) const { kill(child_, signal); }
  // None where it still runs then.
  std::optional<int> wait(std::chrono::milliseconds most) {
    for (const auto end = std::chrono::steady_clock::now() + most; std::chrono::steady_clock::now() < end;) {
      int status = 0;
      if (waitpid(child_, &status, WNOHANG) == child_)
        return exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }

 private:
  int pipe_[2] = {-1, -1};
  pid_t child_ = -1;
  std::optional<int> exit_code_;
};

TEST_CASE("a signal ends the run while nobody takes its messages") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(30));
  for (const int signal : {SIGINT, SIGTERM}) {
    for (const std::string style : {"plain", "bar"}) {
      INFO("signal " << signal << ", " << style);
      const fs::path out = scratch / (style + std::to_string(signal));
      Blocked run({LACUNA_PROGRAM, "detect", scan, "--out", out.string(), "--progress", style});
      const auto has_workspace = [&] { return !temporary_of(out).empty(); };
      for (int i = 0; i < 3000 && !has_workspace(); ++i)
        REQUIRE_FALSE(run.wait(std::chrono::milliseconds(10)));
      REQUIRE_FALSE(run.wait(std::chrono::seconds(1)));  // by now it is blocked
      REQUIRE(has_workspace());
      run.send(signal);
      CHECK(run.wait(std::chrono::seconds(100)) == 128 + signal);
      CHECK_FALSE(fs::exists(out));
    }
  }
}

TEST_CASE("where the summary cannot be written, the error says that the results are complete") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(30));
  const std::string out = (scratch / "out").string();
  for (const std::string redirection : {"> /dev/full", ">&-"}) {
    const ProgramResult result =
        run_in_shell("", {"detect", scan, "--out", out, "--progress", "none"}, redirection);
    check_failure(result, 1, "cannot write to standard output: ");
    CHECK_THAT(result.err, Contains("; the results in " + out + " are complete\n"));
    CHECK(count_entries(out) == 6);
  }
  check_failure(run_in_shell("", {"info", scan}, "> /dev/full"), 1,
                "standard output: No space left on device\n");
}

TEST_CASE("a reader that closes the pipe early, as head does, ends no run with an error") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(30));
  const std::string out = (scratch / "out").string();
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"detect", scan, "--out", out, "--progress", "none"}, {"info", scan}}) {
    const ProgramResult result = run_in_shell("set -o pipefail; exec 3> >(:); sleep 0.1; ", arguments, ">&3");
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
  }
  CHECK(count_entries(out) == 6);
}

TEST_CASE("a folder that cannot be removed after a run is named, and the results are complete") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(300));
  const fs::path out = scratch / "out";
  fs::path held;
  bool is_held = true;
  const auto hold = [&](pid_t) {  // what is mounted cannot be removed
    if (!held.empty() || temporary_of(out).empty()) return;
    held = temporary_of(out) / "held";
    fs::create_directory(held);
    is_held = ::mount("tmpfs", held.c_str(), "tmpfs", 0, "size=4k") == 0;
  };
  const ProgramResult result = run_program_beside({"detect", scan, "--out", out.string(), "--quiet"}, hold);
  if (!is_held) return skip("cannot mount a folder");
  REQUIRE_FALSE(held.empty());
  ::umount(held.c_str());
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.err, StartsWith("lacuna: warning: " + held.parent_path().string()) &&
                             Contains("is not needed any more, but cannot be removed: "));
  CHECK(count_lines(result.err) == 1);
  CHECK(count_entries(out) == 6);
}

TEST_CASE("threads that cannot be started are an error of one line") {
  const ScratchFolder scratch;
  ::chmod((scratch / "").c_str(), 0755);
  fs::create_directory(scratch / "open");
  ::chmod((scratch / "open").c_str(), 0777);
  const std::string scan = scratch.write("open/scan.xyz", sheet(30));
  ::chmod(scan.c_str(), 0644);
  // Root has no such limit; this user has no process of its own.
  const std::string user = std::to_string(50'000 + getpid() % 10'000);
  const auto run = [&](const std::string& limit, const Words& arguments) {
    const Words words = {"setpriv",
                         "--reuid=" + user,
                         "--regid=" + user,
                         "--clear-groups",
                         "bash",
                         "-c",
                         limit + "exec \"$0\" \"$@\"",
                         LACUNA_PROGRAM};
    return run_command(with(words, arguments));
  };
  if (geteuid() != 0 || run("", {"--version"}).exit_code != 0)
    return skip("cannot run the program as another user");
  // For a user who may have fewer than five, OpenVDB's logging library ends the program before it begins.
  for (const std::string limit : {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11"}) {
    INFO("ulimit -u " << limit);
    const fs::path out = scratch / "open" / limit;
    check_failure(run("ulimit -u " + limit + "; ",
                      {"detect", scan, "--out", out.string(), "--quiet", "--threads", "8"}),
                  1, "thread");
    CHECK(names_of(scratch / "open") == Words{"scan.xyz"});
  }
}

TEST_CASE("a process that is allowed too little stack or too few files ends with one line") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.xyz", sheet(30));
  const std::string out = (scratch / "out").string();
  const std::vector<std::pair<std::string, std::string>> limits = {
      {"ulimit -s 64; ", "the system allows this process 64 KiB of stack (ulimit -s); allowed: 1024 or more"},
      {"ulimit -n 20; ", "the system allows this process 20 open files (ulimit -n); allowed: 256 or more"},
      {"ulimit -d 30000; ", "no more memory or threads"},
  };
  for (const auto& [limit, reason] : limits) {
    for (const Words& command : std::vector<Words>{{"detect", scan, "--out", out}, {"info", scan}})
      check_failure(run_in_shell(limit, command), 1, reason);
  }
  CHECK(scratch.names() == Words{"scan.xyz"});
  CHECK(run_in_shell("ulimit -s 1024 -n 256; ", {"detect", scan, "--out", out, "--quiet"}).exit_code == 0);
}

TEST_CASE("a name of thousands of bytes is shortened in the line of its error") {
  const ScratchFolder scratch;
  const ProgramResult result =
      run_program({"info", "@" + scratch.write("list", "begin" + std::string(2400, 'n') + "end.xyz\n")});
  check_failure(result, 1, " ... ");
  CHECK(result.err.size() < 1100);
  CHECK_THAT(result.err, Contains("beginnnn") && Contains("nnnend.xyz: "));
}

TEST_CASE("an input that is replaced during a run ends it, and leaves nothing") {
  const ScratchFolder scratch;
  const std::string text = sheet(150);
  const fs::path out = scratch / "out";
  const std::string scan = scratch.write("scan.xyz", text), other = scratch.write("other", text);
  const auto replace_when_read = [&] {
    const bool is_read = fs::exists(temporary_of(out) / "results");
    if (is_read) fs::rename(other, scan);
    return is_read;
  };
  // SIGCONT changes nothing.
  check_failure(
      run_program_until({"detect", scan, "--out", out.string(), "--quiet"}, SIGCONT, replace_when_read), 1,
      "scan.xyz: has changed during the run (");
  CHECK_FALSE(fs::exists(out));
}

// Line ends aside.
bool has_control_characters(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\n') || byte == 0x7f) return true;
    const bool is_lead_of_c1 =
        byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    if (is_lead_of_c1 || (byte >= 0x80 && byte < 0xa0 && (i == 0 || !(text[i - 1] & 0x80)))) return true;
  }
  return false;
}

TEST_CASE("control characters of files and their names never reach the terminal, letters do") {
  const ScratchFolder scratch;
  const std::string letters = "Größe",
                    evil = std::string("\033]0;pwned\a\177\xc2\x9b") + "2J\x9b" + "3J_" + letters;
  const auto is_clean = [&](const ProgramResult& result) {
    INFO(result.out << result.err);
    CHECK_FALSE(has_control_characters(result.out));
    CHECK_FALSE(has_control_characters(result.err));
    CHECK_THAT(result.out + result.err, Contains(letters));
  };
  fs::create_directory(scratch / evil);
  const std::string scan =
      scratch.write(evil + "/scan\nof.ply", ascii_ply("1 2 3 4\n", kXyz + "property float " + evil + "\n"));
  const ProgramResult info = run_program({"info", scan});
  CHECK(info.exit_code == 0);
  is_clean(info);
  const std::string shown = std::string("\\u001b]0;pwned\\u0007\\u007f\\u009b2J\\x9b") + "3J_";
  CHECK_THAT(info.out, StartsWith((scratch / shown).string()) && Contains("scan\\u000aof.ply\n"));
  is_clean(run_program({"detect", scan, "--out", (scratch / evil / "out").string(), "--workspace",
                        (scratch / evil / "w").string()}));
  is_clean(run_program({"info", scan + "none"}));
  is_clean(run_program({"info", scan, "--" + evil}));
  const std::string key = "[criteria]\n\"\\u001b\\u009b\\u0007 " + letters + "\" = 1\n";
  is_clean(run_program({"detect", "--print-config", "--config", scratch.write("key.toml", key)}));
  is_clean(run_bench({"synth", "surface", (scratch / evil / "made.ply").string(), "--points", "20000"}));

  // What other programs read keeps the name.
  const std::string header = read_file(scratch / evil / "out" / "holes.json");
  const std::string name = std::string("\033]0;pwned\a\177\xc2\x9b") + "2J\xef\xbf\xbd" + "3J_" + letters;
  const ProgramResult json = run_program({"info", scan, "--json"});
  is_clean(json);
  CHECK(json_of(json.out).at("files").at(0).at("properties").at(3).at("name") == name);
  CHECK(json_of(header).at("inputs").at(0).at("properties").contains(name));
}

double cpu_seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + static_cast<double>(usage.ru_utime.tv_usec) * 1e-6;
}

TEST_CASE("nine thousand columns take a moment, and forty thousand are refused") {
  const ScratchFolder scratch;
  const auto scans_of = [&](int columns) {
    std::string properties = kXyz, names = "x y z", row = "1 2 3";
    for (int i = 0; i < columns; ++i) {
      properties += "property char p" + std::to_string(i) + "\n";
      names += " c" + std::to_string(i);
      row += " 4";
    }
    row += "\n";
    return std::vector{scratch.write("wide.ply", ascii_ply(row + row, properties)),
                       scratch.write("wide.xyz", names + "\n" + row + row)};
  };
  for (const std::string& scan : scans_of(40'000)) check_failure(run_program({"info", scan}), 1, "10,000");
  for (const std::string& scan : scans_of(9'000)) {
    const double before = cpu_seconds_of_children();
    CHECK(run_program({"info", scan}).exit_code == 0);
    detect(scan, scratch / "out", {"--points"});
    CHECK(cpu_seconds_of_children() - before < 2);
  }
}

}  // namespace
}  // namespace lacuna::test
