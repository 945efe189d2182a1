// SPDX-License-Identifier: Apache-2.0
#include "io/options/options.hpp"
#include "tests/io/las/las_file.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sheet.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using test::check_failure;
using test::count_entries;
using test::ProgramResult;
using test::run_program;
using test::ScratchFolder;
using test::sheet;

TEST_CASE("info counts classes and returns", "[program]") {
  const ScratchFolder folder;
  const std::string scan = folder.write("a.txt",
                                        "x y z classification return_number number_of_returns\n"
                                        "0 0 0 2 1 1\n1 0 0 2 1 2\n2 0 0 5 2 2\n3 0 0 40 1 1\n");
  const auto text = run_program({"info", scan});
  CHECK_THAT(text.out, Contains("classes     2 ground 2 · 5 high vegetation 1 · 40 1\n"));
  CHECK_THAT(text.out, Contains("returns     2 only, 1 first of several, 1 later\n"));
  const auto json = nlohmann::json::parse(run_program({"info", "--json", scan}).out)["files"][0];
  CHECK(json["classes"] == nlohmann::json{{"2", 2}, {"5", 1}, {"40", 1}});
  CHECK(json["returns"] == nlohmann::json{{"only", 2}, {"first", 1}, {"later", 1}});
  CHECK_THAT(run_program({"info", folder.write("b.xyz", "1 2 3\n")}).out, !Contains("classes"));
}

TEST_CASE("a run counts its loops in words") {
  const ScratchFolder scratch;
  const auto summary_of = [&](const char* kind) {
    const std::string scan = (scratch / (std::string(kind) + ".ply")).string();
    test::run_bench({"synth", "surface", scan, "--kind", kind, "--points", "10000", "--holes", "1"});
    return run_program({"detect", scan, "--out", (scratch / kind).string()}).out;
  };
  CHECK_THAT(summary_of("plane"), StartsWith("1 hole, 1 outer curve; 2 longer than 0.1\n"));
  CHECK_THAT(summary_of("torus"), StartsWith("1 hole, 0 outer curves; 1 longer than 0.1\n"));
}

TEST_CASE("help is for everything and version is one line") {
  CHECK(run_program({"--version"}).out == "lacuna 0.1.0\n");
  CHECK_THAT(run_program({"--help"}).out, Contains("detect") && Contains("info"));
  const ProgramResult help = run_program({"detect", "--help-all"});
  CHECK(help.exit_code == 0);
  CHECK(help.err.empty());
  io::FilesConfig config;
  for (const Parameter& parameter : parameters(config)) {
    if (parameter.is_constant) continue;
    CHECK_THAT(help.out, Contains(parameter.option()) && Contains(std::string(parameter.section) + ":\n"));
  }
}

TEST_CASE("--help shows the options that people use, and --help-all of the program has every command") {
  const std::string common = run_program({"detect", "--help"}).out;
  for (const char* option : {"--out", "--min-hole", "--report", "--points", "--help-all"})
    CHECK_THAT(common, Contains(option));
  for (const char* option : {"--sigma", "--print-config", "--progress"})
    CHECK_THAT(common, !Contains(option));
  CHECK(test::count_lines(common) < 30);
  const std::string all = run_program({"--help-all"}).out;
  for (const char* part :
       {"detect", "--sigma", "--print-config", "render", "--hide-above", "clean", "WORKSPACE"})
    CHECK_THAT(all, Contains(part));
}

TEST_CASE("wrong usage has exit code 2 and one line that names it") {
  check_failure(run_program({}), 2, "subcommand");
  check_failure(run_program({"detect"}), 2, "SCAN");
  check_failure(run_program({"detect", "a.ply"}), 2, "--out");
  check_failure(run_program({"detect", "a.ply", "--out"}), 2, "--out");
  check_failure(run_program({"detect", "a.ply", "--out", ""}), 2, "--out");
  check_failure(run_program({"detect", "a.ply", "--out", "d", "--k", "0"}), 2, "k = 0");
  check_failure(run_program({"detect", "a.ply", "--out", "d", "--k", "3", "--k", "4"}), 2, "--k");
  check_failure(run_program({"detect", "a.ply", "--out", "d", "--eps", "1", "--eps-fraction", "0.1"}), 2,
                "eps");
  check_failure(run_program({"detect", "a.ply", "--out", "d", "--progress", "2"}), 2, "bar, plain, none");
  check_failure(run_program({"info"}), 2, "SCAN");
  check_failure(test::run_bench({"synth", "sculpture"}), 2, "surface, scan");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--kind", "bottle"}), 2, "torus");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--points", "abc"}), 2,
                "lacuna-bench synth surface --help");
  check_failure(test::run_bench({"synth", "surface", "x.las"}), 2,
                "x.las is not possible; allowed: a name that ends in .ply");
  check_failure(run_program({"render", "d", "--out", "x.jpg"}), 2, "allowed: a name that ends in .png");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--points", "0", "--holes", "0"}), 2,
                "--points 0");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--points", "400", "--holes", "90"}), 2,
                "--holes 90");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--kind", "sphere", "--density-step", "4"}), 2,
                "--density-step");
  check_failure(test::run_bench({"synth", "surface", "d.ply", "--positions", "random", "--jitter", "0.1"}), 2,
                "--jitter");
  check_failure(test::run_bench({"synth", "scan", "d.ply", "--stations", "0"}), 2, "--stations");
  check_failure(test::run_bench({"synth", "scan", "d.ply", "--truth", "d.ply"}), 2, "two files");
  CHECK_FALSE(fs::exists("d"));
  CHECK_FALSE(fs::exists("x.las"));
  CHECK_FALSE(fs::exists("x.jpg"));
}

TEST_CASE("a value with a unit or a decimal comma is refused with what a number is") {
  const std::string form = "a number without a unit, with a decimal point";
  for (const std::string value : {"5cm", "0.1m", "0,5"}) {
    check_failure(run_program({"detect", "a.ply", "--out", "d", "--min-hole", value}), 2, form);
    check_failure(test::run_bench({"synth", "surface", "d.ply", "--spacing", value}), 2, form);
    check_failure(test::run_bench({"synth", "scan", "d.ply", "--field-of-view", "-30", value}), 2, form);
    check_failure(run_program({"render", "d", "--out", "d.png", "--hide-above", value}), 2, form);
    check_failure(test::run_bench({"evaluate", "d", "d.txt", "--tolerance", value}), 2, form);
  }
  CHECK_THAT(run_program({"detect", "a.ply", "--out", "d", "--min-hole", "-1"}).err, !Contains(form));
}

TEST_CASE("a mistyped option or command is reported with the one that may be meant") {
  check_failure(run_program({"detetc"}), 2,
                "unknown command \"detetc\" (did you mean \"detect\"?); allowed: detect");
  check_failure(test::run_bench({"synth", "surfac"}), 2, "(did you mean \"surface\"?)");
  check_failure(run_program({"help", "surfac"}), 2, "unknown command \"surfac\"; allowed: detect");
  const ProgramResult mistyped = run_program({"detect", "a.ply", "--min-hol", "3", "--out", "d"});
  check_failure(mistyped, 2, "unknown option --min-hol (did you mean \"--min-hole\"?)");
  const auto begun = test::run_program({"detect", "scan.ply", "--mem", "1GiB"});
  check_failure(begun, 2, "unknown option --mem (did you mean \"--memory-limit\"?)");
  CHECK_THAT(mistyped.err, Contains("see lacuna detect --help"));
  check_failure(run_program({"detect", "a.ply", "--out", "d", "--colour=3"}), 2,
                "unknown option --colour (see");
}

TEST_CASE("lacuna help COMMAND is the help of the command") {
  CHECK(run_program({"help"}).out == run_program({"--help"}).out);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"detect"}, {"info"}}) {
    std::vector<std::string> asked = {"help"}, flagged = words;
    asked.insert(asked.end(), words.begin(), words.end());
    flagged.push_back("--help");
    CHECK(run_program(asked).out == run_program(flagged).out);
  }
  CHECK(test::run_bench({"help", "synth", "scan"}).out == test::run_bench({"synth", "scan", "--help"}).out);
  CHECK(test::run_bench({"--version"}).out == "lacuna-bench 0.1.0\n");
  CHECK(run_program({"-V"}).out == run_program({"--version"}).out);
}

TEST_CASE("standard input as a scan is an error that says what to do") {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  check_failure(run_program({"detect", "-", "--out", out}), 1, "save it in a file");
  check_failure(run_program({"info", "-"}), 1, "standard input is not read");
}

TEST_CASE("a config is found by the name that it is installed with") {
  const ProgramResult named = run_program({"detect", "--print-config", "--config", "aerial"});
  const std::string file = LACUNA_SOURCE_DIR "/configs/aerial.toml";
  CHECK(named.exit_code == 0);
  CHECK(named.out == run_program({"detect", "--print-config", "--config", file}).out);
  check_failure(
      run_program({"detect", "--print-config", "--config", "aerail"}), 2,
      "--config aerail: no file and no installed config has this name (did you mean \"aerial\"?); allowed: "
      "a TOML file, or one of these: aerial, default");
}

TEST_CASE("the command line overrides the config file, and the file the defaults") {
  const ScratchFolder scratch;
  const std::string file =
      scratch.write("c.toml", "[neighbourhood]\nk = 20\n[output]\npoints = true\n[spanning]\ne = 9\n");
  const ProgramResult result =
      run_program({"detect", "--print-config", "--config", file, "--k", "30", "--points=false"});
  CHECK_THAT(result.out, Contains("\nk = 30\n") && Contains("\npoints = false\n") && Contains("\ne = 9\n") &&
                             Contains("\ncone = 15.0\n"));
}

TEST_CASE("a fault in a config file is reported with file, line and key") {
  const ScratchFolder scratch;
  const std::string unknown = scratch.write("unknown.toml", "[criteria]\nsigmas = 1\n");
  check_failure(run_program({"detect", "--print-config", "--config", unknown}), 2,
                "unknown.toml:2: unknown key \"sigmas\" in [criteria] (did you mean \"sigma\"?)");
  const std::string impossible = scratch.write("impossible.toml", "[criteria]\ncone = 90\n");
  check_failure(run_program({"detect", "--print-config", "--config", impossible}), 2,
                "impossible.toml:2: cone");
  check_failure(run_program({"detect", "--print-config", "--config", (scratch / "no.toml").string()}), 2,
                "no.toml");
}

TEST_CASE("an input that cannot be read leaves no output folder") {
  const ScratchFolder scratch;
  const std::string out = (scratch / "a/b/out").string();
  fs::create_directory(scratch / "nothing");
  for (const std::string& scan :
       {(scratch / "none.ply").string(), (scratch / "nothing").string(), scratch.write("empty.ply", ""),
        scratch.write("cut.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n0 0 0\n")}) {
    check_failure(run_program({"detect", scan, "--out", out, "--progress", "none"}), 1, scan);
    check_failure(run_program({"info", scan}), 1, scan);
    CHECK_FALSE(fs::exists(scratch / "a"));
  }
}

TEST_CASE("an output folder that cannot be is an error") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(8));
  check_failure(run_program({"detect", scan, "--out", scan}), 1, "scan.txt: not a folder");
  check_failure(run_program({"detect", scan, "--out", scan + "/below"}), 1, "scan.txt");
  check_failure(run_program({"detect", scan, "--out", "/proc/lacuna"}), 1, "/proc/lacuna");
  CHECK(test::read_file(scan) == sheet(8));
}

TEST_CASE("a run creates its folder, prints what it found and leaves nothing else") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(40));
  const fs::path out = scratch / "new/folder";
  const ProgramResult result = run_program({"detect", scan, "--out", out.string()});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("1,500 points") && Contains("peak memory") && Contains("points/s") &&
                             Contains("largest holes") && Contains((out / "holes.json").string()));
  CHECK_THAT(result.err, Contains("done in") && !Contains("\r"));
  CHECK(fs::exists(out / "holes.json"));
  CHECK(count_entries(out) == 6);  // and no workspace
}

TEST_CASE("a quiet run says nothing") {
  const ScratchFolder scratch;
  const ProgramResult result = run_program(
      {"detect", scratch.write("scan.txt", sheet(20)), "--out", (scratch / "out").string(), "--quiet"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.empty());
  CHECK(result.err.empty());
}

TEST_CASE("a run says which programs cannot read the 64-bit coordinates that it wrote") {
  const ScratchFolder scratch;
  const auto output = [&](const std::string& scan, const std::string& format,
                          const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {
        "detect",          scan,   "--out",      (scratch / "out").string(), "--points",
        "--points-format", format, "--overwrite"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words).out;
  };
  const std::string doubles = scratch.write("scan.txt", sheet(20));
  const std::string note = "note: PCL takes the 64-bit coordinates of PLY ";
  CHECK_THAT(output(doubles, "csv"), Contains(note + "files for 0 0 0; --local-coordinates helps, or "));
  const std::string floats = scratch.write(
      "scan.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n1 2 3\n");
  CHECK_THAT(output(floats, "ply"), Contains("written: ") && !Contains("note:"));
  CHECK_THAT(output(doubles, "ply", {"--local-coordinates"}), Contains("written: ") && !Contains("note:"));
}

TEST_CASE("temporary files go to a folder elsewhere, and are gone at the end") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(20));
  REQUIRE(run_program({"detect", scan, "--out", (scratch / "out").string(), "--scratch",
                       (scratch / "temporary").string()})
              .exit_code == 0);
  CHECK_FALSE(fs::exists(scratch / "temporary"));  // made for the run, empty after it
}

TEST_CASE("one run at a time writes to a folder, and warns of what a killed one has left there") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(20));
  const fs::path out = scratch / "out";
  fs::create_directory(out);
  fs::create_directory(out / ".lacuna-killed");
  const int other = open(out.c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(flock(other, LOCK_EX) == 0);
  check_failure(run_program({"detect", scan, "--out", out.string()}), 1,
                "another run writes its results there");
  CHECK(count_entries(out) == 1);
  close(other);
  const ProgramResult result = run_program({"detect", scan, "--out", out.string(), "--quiet"});
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.err, Contains(".lacuna-killed") && Contains("left by a run that was killed"));
  CHECK(count_entries(out) == 7);
}

TEST_CASE("a file of another program under any result's name is refused before the work, or replaced") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(20));
  const fs::path out = scratch / "out";
  const std::vector<std::string> plain = {"detect", scan, "--out", out.string(), "--quiet"};
  std::vector<std::string> all = plain;
  all.insert(all.end(), {"--points", "--points-format", "ply", "--vdb", "--lids", "--obj", "--cut-outs", "1",
                         "--report"});
  fs::create_directories(out / "cut-outs");
  const std::string mine = "x y z\n1 2 3\n";
  for (const std::string name :
       {"points.ply", "probability.vdb", "lids.obj", "lids.ply", "lids.csv", "loops.obj", "loops.ply",
        "boundary.ply", "sample.ply", "holes.json", "holes.csv", "report.html", "cut-outs/hole-3.ply"}) {
    INFO(name);
    scratch.write("out/" + name, mine);
    check_failure(run_program(all), 1, name + ": exists, and this command did not write it");
    CHECK(test::read_file(out / name) == mine);
    CHECK(fs::exists(out / "points.ply") == (name == "points.ply"));
    fs::remove(out / name);
  }
  scratch.write("out/points.ply", mine);
  all.emplace_back("--overwrite");
  REQUIRE(run_program(all).exit_code == 0);
  all.pop_back();
  CHECK(run_program(all).exit_code == 0);  // its own files
  CHECK(count_entries(out) == 14);
  CHECK(run_program(plain).exit_code == 0);  // removes what it does not write
  CHECK(count_entries(out) == 6);
}

TEST_CASE("files, links, folders and pipes of like names are not touched, by a signal neither") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(400));
  const fs::path out = scratch / "out";
  fs::create_directory(out);
  const std::string mine = scratch.write("mine", "precious");
  scratch.write("out/boundary.ply.partial", "precious");
  fs::create_symlink(mine, out / "loops.ply.partial");
  REQUIRE(mkfifo((out / "points.ply.partial").c_str(), 0600) == 0);
  fs::create_directories(out / "holes.json.partial" / "mine");
  const std::vector<std::string> arguments = {"detect",          scan,  "--out",  out.string(), "--points",
                                              "--points-format", "ply", "--quiet"};
  const auto is_untouched = [&] {
    return test::read_file(mine) == "precious" &&
           test::read_file(out / "boundary.ply.partial") == "precious" &&
           fs::is_symlink(out / "loops.ply.partial") && fs::is_fifo(out / "points.ply.partial") &&
           fs::exists(out / "holes.json.partial" / "mine");
  };
  const ProgramResult ended =
      test::run_program_until(arguments, SIGTERM, [&] { return count_entries(out) > 4; });
  CHECK(ended.exit_code == 128 + SIGTERM);
  CHECK(count_entries(out) == 4);
  CHECK(is_untouched());
  CHECK(run_program(arguments).exit_code == 0);
  CHECK(count_entries(out) == 11);
  CHECK(is_untouched());
}

TEST_CASE("a signal while results replace older ones leaves the older ones or all new ones") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(300));
  const fs::path out = scratch / "out";
  const std::vector<std::string> arguments = {"detect",          scan,  "--out",  out.string(), "--points",
                                              "--points-format", "ply", "--quiet"};
  REQUIRE(run_program(arguments).exit_code == 0);
  const std::string before = test::read_file(out / "holes.json");
  const auto is_writing = [&] {
    const auto entries = fs::recursive_directory_iterator(out, fs::directory_options::skip_permission_denied);
    return std::any_of(begin(entries), end(entries),
                       [](const auto& entry) { return entry.path().string().ends_with("new/holes.json"); });
  };
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const auto written = fs::last_write_time(out / "holes.json");
    const ProgramResult result = test::run_program_until(arguments, signal, is_writing);
    for (const char* name : {"loops.ply", "boundary.ply", "points.ply"}) CHECK(fs::exists(out / name));
    const std::string after = test::read_file(out / "holes.json");
    CHECK(after == before);
    if (fs::last_write_time(out / "holes.json") != written) {  // a busy machine: all new ones were in place
      if (result.exit_code == 128 + signal && signal != SIGKILL)
        CHECK(result.err == "lacuna: interrupted; the results in " + out.string() + " are complete\n");
      continue;
    }
    CHECK(result.exit_code == 128 + signal);
    if (signal != SIGKILL) CHECK(result.err == "lacuna: interrupted; " + out.string() + " is as it was\n");
    CHECK(count_entries(out) == (signal == SIGKILL ? 9 : 7));  // the workspace, and the results half-written
  }
}

TEST_CASE("a signal while a scan is made leaves nothing") {
  const ScratchFolder scratch;
  const auto is_writing = [&] { return count_entries(scratch.path()) > 0; };
  const ProgramResult result =
      test::run_program_until({"synth", "surface", (scratch / "made.ply").string(), "--points", "20000000"},
                              SIGINT, is_writing, test::Program::kBench);
  CHECK(result.exit_code == 128 + SIGINT);
  CHECK(result.err == "lacuna-bench: interrupted\n");
  CHECK(count_entries(scratch.path()) == 0);
}

TEST_CASE("names of columns are divided by blanks or commas") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(20));
  CHECK(run_program({"info", "--columns", "z y x", scan}).exit_code == 0);
  CHECK(run_program({"info", "--columns", "z,y,x", scan}).exit_code == 0);
  check_failure(run_program({"info", "--columns", "a,b,c", scan}), 1, "no columns named x, y and z");
}

TEST_CASE("a signal ends the run and removes the workspace") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const ScratchFolder scratch;
    const std::string scan = scratch.write("scan.txt", sheet(600));
    const fs::path out = scratch / "out";
    const auto has_workspace = [&out] { return fs::exists(out) && count_entries(out) > 0; };
    const ProgramResult result =
        test::run_program_until({"detect", scan, "--out", out.string()}, signal, has_workspace);
    CHECK(result.exit_code == 128 + signal);
    CHECK_THAT(result.err,
               !Contains("error") && EndsWith("lacuna: interrupted; " + out.string() + " is as it was\n"));
    CHECK_FALSE(fs::exists(out));
  }
}

TEST_CASE("info prints the size of the annotated scan, whatever the files hold") {
  const ScratchFolder scratch;
  const std::string text = scratch.write("scan.txt", sheet(20));
  const std::string ply = scratch.write(
      "one.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty int scalar_loop\nend_header\n"
      "3 4 0 0 0 1 7\n");
  for (const std::vector<std::string>& scans : {std::vector<std::string>{text}, {ply}, {text, ply}}) {
    for (const std::string format : {"ply", "csv"}) {
      std::vector<std::string> arguments = {"info",   "--points",        "--normals",
                                            "--json", "--points-format", format};
      arguments.insert(arguments.end(), scans.begin(), scans.end());
      const auto told = nlohmann::json::parse(run_program(arguments).out);
      arguments[0] = "detect";
      arguments[3] = "--quiet";
      arguments.insert(arguments.end(), {"--out", (scratch / "out").string()});
      REQUIRE(run_program(arguments).exit_code == 0);
      REQUIRE(told.at("points_file") == "points." + format);
      const std::string points = test::read_file(scratch / "out" / ("points." + format));
      std::size_t header = 0;
      if (format == "ply") header = points.find("end_header\n") + 11;
      if (format == "ply") CHECK(told.at("points_bytes") == points.size() - header);
    }
  }
}

TEST_CASE("info reads a LAS file whose columns leave no room for results") {
  const ScratchFolder scratch;
  test::LasFile las{.minor = 2, .format = 0};
  std::string descriptors;
  for (int i = 0; i < 340; ++i) descriptors += test::las_extra_descriptor(std::to_string(i), 1);
  las.records = {test::las_record("LASF_Spec", 4, descriptors)};
  for (int i = 0; i < 100; ++i) las.points.push_back(test::las_point(20 + 340, i % 10, i / 10, 0));
  const std::string scan = scratch.write("wide.las", las.bytes());
  const ProgramResult info = run_program({"info", scan});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.out, Contains("points/    cannot hold all columns; --points-format ply can"));
  CHECK_THAT(run_program({"info", scan, "--json"}).out, Contains("\"points_bytes\": null"));
  check_failure(run_program({"info", scan, "--points"}), 1, "--points-format ply holds them all");
}

TEST_CASE("info prints what files hold and what a run would take, and writes nothing") {
  const ScratchFolder scratch;
  const std::string text = scratch.write("scan.txt", sheet(8));
  const std::string ply = scratch.write("one.ply",
                                        "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\n"
                                        "property double y\nproperty double z\n"
                                        "property uchar red\nend_header\n100 0 -5 7\n");
  const ProgramResult told = run_program({"info", text, ply});
  INFO(told.err);
  REQUIRE(told.exit_code == 0);
  CHECK_THAT(told.out, Contains("PLY, ascii") && Contains("red (uchar)") && Contains("points        61"));

  const ProgramResult result = run_program({"info", text, ply, "--json", "--points"});
  const auto root = nlohmann::json::parse(result.out);
  CHECK(root.at("points") == 61);
  CHECK(root.at("files").at(0).at("format") == "text");
  CHECK(root.at("files").at(1).at("points") == 1);
  CHECK(root.at("files").at(1).at("properties").at(3).at("type") == "uchar");
  CHECK(root.at("bounds").at("max").at(0) == 100);
  CHECK(root.at("bounds").at("min").at(2) == -5);
}

}  // namespace
}  // namespace lacuna
