// SPDX-License-Identifier: Apache-2.0
#include "io/read/options/options.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/json.hpp"
#include "tests/support/las_file.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

TEST_CASE("info counts classes and returns", "[program]") {
  const ScratchFolder folder;
  const std::string scan = folder.write("a.txt",
                                        "x y z classification return_number number_of_returns\n"
                                        "0 0 0 2 1 1\n1 0 0 2 1 2\n2 0 0 5 2 2\n3 0 0 40 1 1\n");
  CHECK_THAT(run_program({"info", scan}).out,
             Contains("classes     2 ground 2 · 5 high vegetation 1 · 40 1\n") &&
                 Contains("returns     2 only, 1 first of several, 1 later\n"));
  const auto json = json_of(run_program({"info", "--json", scan}).out)["files"][0];
  CHECK(json["classes"] == nlohmann::json{{"2", 2}, {"5", 1}, {"40", 1}});
  CHECK(json["returns"] == nlohmann::json{{"only", 2}, {"first", 1}, {"later", 1}});
  CHECK_THAT(run_program({"info", folder.write("b.xyz", "1 2 3\n")}).out, !Contains("classes"));
}

TEST_CASE("a run counts its loops in words") {
  const ScratchFolder scratch;
  const auto summary_of = [&](const char* kind) {
    const std::string scan =
        synth("surface", scratch / "a.ply", {"--kind", kind, "--points", "10000", "--holes", "1"});
    return run_program({"detect", scan, "--out", (scratch / kind).string()}).out;
  };
  CHECK_THAT(summary_of("plane"), StartsWith("1 hole, 1 outer curve\n"));
  CHECK_THAT(summary_of("torus"), StartsWith("1 hole, 0 outer curves\n"));
}

TEST_CASE("progress for programs is an object of JSON a line, whose share of the run goes up to 1") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "a.ply", {"--points", "10000", "--holes", "1"});
  std::istringstream lines(
      run_program({"detect", scan, "--out", (scratch / "out").string(), "--progress", "json"}).err);
  double share = 0;
  std::string step;
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    if (!line.starts_with('{')) continue;  // a warning
    const auto state = json_of(line);
    CHECK(state.at("run_share") >= share);
    share = state.at("run_share");
    step = state.at("step");
  }
  CHECK(share == Approx(1));
  CHECK(step == "write");
}

TEST_CASE("a smallest hole that thins nothing is a warning, one that thins is none") {
  const ScratchFolder scratch;
  const std::string scan = synth("surface", scratch / "a.ply", {"--points", "10000", "--holes", "1"});
  const auto warnings = [&](const char* min_hole) {
    return run_program(
               {"detect", scan, "--out", (scratch / min_hole).string(), "--quiet", "--min-hole", min_hole})
        .err;
  };
  CHECK_THAT(warnings("0.0001"), Contains("--min-hole 0.0001 thins nothing: neighbours are 0.0"));
  CHECK(warnings("0.3").empty());
}

TEST_CASE("help shows the options that people use, --help-all every one, and version is one line") {
  CHECK(run_program({"--version"}).out == "lacuna 0.1.0\n");
  CHECK(run_program({"-V"}).out == run_program({"--version"}).out);
  CHECK(run_bench({"--version"}).out == "lacuna-bench 0.1.0\n");
  const ProgramResult common = run_program({"detect", "--help"}), all = run_program({"--help-all"});
  for (const char* option : {"--out", "--min-hole", "--report", "--points", "--help-all"})
    CHECK_THAT(common.out, Contains(option));
  for (const char* option : {"--resolution", "--print-config", "--progress"})
    CHECK_THAT(common.out, !Contains(option));
  CHECK(count_lines(common.out) < 30);
  CHECK(common.err.empty());
  for (const char* part : {"detect", "render", "--hide-above", "clean", "WORKSPACE"})
    CHECK_THAT(all.out, Contains(part));
  const std::string help = run_program({"detect", "--help-all"}).out;
  for (const char* part : {"search:\n", "selection:\n", "--min-points", "run:\n"})
    CHECK_THAT(help, Contains(part));
  CHECK(count_lines(help) < 70);
  CHECK(run_program({"help"}).out == run_program({"--help"}).out);
  CHECK(run_program({}).out == run_program({"--help"}).out);
  for (const char* command : {"detect", "info"})
    CHECK(run_program({"help", command}).out == run_program({command, "--help"}).out);
  CHECK(run_bench({"help", "synth", "scan"}).out == run_bench({"synth", "scan", "--help"}).out);
}

TEST_CASE("wrong usage has exit code 2 and one line that names it") {
  const ScratchFolder scratch;
  const std::string config = scratch.write("c.toml", "[criteria]\nsigmas = 1\n"),
                    scan = scratch.write("scan.ply", ascii_ply("1 2 3\n"));
  const auto check = [](const std::vector<Words>& commands, const auto& run) {
    for (Words words : commands) {
      const std::string part = words.back();
      words.pop_back();
      INFO(Catch::StringMaker<Words>::convert(words));
      check_failure(run(words), 2, part);
    }
  };
  // The last word is a part of the message.
  check(
      {{config, config + ": a file; allowed: a command before it, such as lacuna detect " + config},
       {"detetc", "unknown command \"detetc\" (did you mean \"detect\"?); allowed: detect"},
       {"help", "surfac", "unknown command \"surfac\"; allowed: detect"},
       {"detect", "SCAN"},
       {"detect", "a.ply", "--out"},
       {"detect", "a.ply", "--out", "", "--out"},
       {"detect", "a.ply", "--out", "d", "--k", "0", "k = 0"},
       {"detect", "a.ply", "--out", "d", "--workspace", "d", "; allowed: another one for --workspace"},
       {"detect", "a.ply", "--out", "d", "--scratch", "d/in", "; allowed: another one for --scratch"},
       {"detect", "a.ply", "--out", "d", "--k", "3", "--k", "4", "--k is given more than once (see"},
       {"detect", "a.ply", "--out", "d", "--coverage", "--coverage lacks a value (see"},
       {"detect", "a.ply", "--out", "d", "--bounds", "1", "bounds has 1 number; allowed: 4 (min x y, max"},
       {"detect", "a.ply", "--cone", "20",
        "--cone: is no option; a file for --config sets it, in its section [criteria]: cone = 15.0"},
       {"detect", "a.ply", "--area", "a.gpkg", "unknown option --area; lacuna check has it"},
       {"detect", "a.ply", "--pose", "a.xf", "unknown option --pose; a list of files has poses"},
       {"detect", "a.ply", "--poses=a.xf", "--poses; a list of files has poses: @LIST with lines such"},
       {"detect", "a.ply", "--out", "d", "--every-point", "--resolution", "1",
        "every_point and resolution are both set; allowed: at most one of them"},
       {"detect", scan, "--out", "d", "--columns", "x,y,z", "--columns: names columns of text, and no file"},
       {"check", "a.ply", "--area", "a.gpkg", "--void-rule is required for an area; allowed: a length"},
       {"stations", "d", "--count", "0",
        "--count: 0 is not possible; allowed: a whole number from 1 to 1000"},
       {"work", "d", "--step", "bucket", "--task", "x", "--task: x is not possible; allowed: a whole number"},
       {"report", "d", "x", "error: not expected: x (see lacuna report --help)"},
       {"detect", "a.ply", "--out", "d", "--progress", "2", "bar, plain, json, none"},
       {"detect", "a.ply", "--min-hol", "3", "(did you mean \"--min-hole\"?) (see lacuna detect --help)"},
       {"detect", "a.ply", "--mem", "1GiB", "--mem (did you mean \"--memory-limit\"?)"},
       {"detect", "a.ply", "--out", "d", "--colour=3", "unknown option --colour (see"},
       {"detect", "a.ply", "-o", "d", "unknown option -o (did you mean \"--out\"?)"},
       {"detect", "a.ply", "--output", "d", "unknown option --output (did you mean \"--out\"?)"},
       {"detect", "-i", "a.ply", "unknown option -i; the names of inputs need no option"},
       {"check", "a.ply", "--points",
        "unknown option --points; lacuna detect has it (see lacuna check --help)"},
       {"version", "unknown command \"version\" (did you mean \"--version\"?)"},
       {"--v", "unknown option --v (did you mean \"--version\"?)"},
       {"detect", "--version", "unknown option --version; it has no command before it: lacuna --version"},
       {"info", "a.ply", "-o", "unknown option -o; the names of files need no option"},
       {"check", "a.laz", "--class", "2", "\"--classes\"?); --where 'Classification == 2' chooses points"},
       {"detect", "a.laz", "--classification", "2", "; --where 'Classification == 2' chooses points"},
       {"detect", "--print-config", "--config", config, "c.toml:2: unknown key \"sigmas\""},
       {"detect", "--print-config", "--config", "aerail",
        "(did you mean \"aerial\"?); allowed: a TOML file, or one of these: aerial"},
       {"detect", "--print-config", "--config", "no.toml", "no.toml: cannot be opened"},
       {"info", "SCAN"},
       {"render", "d", "--out", "x.jpg", "allowed: a name that ends in .png"}},
      [](const Words& words) { return run_program(words); });
  check({{"synth", "sculpture", "surface, scan"},
         {"synth", "surfac", "(did you mean \"surface\"?)"},
         {"synth", "surface", "d.ply", "--kind", "bottle", "torus"},
         {"synth", "surface", "d.ply", "--points", "abc", "lacuna-bench synth surface --help"},
         {"synth", "surface", "x.las", "x.las is not possible; allowed: a name that ends in .ply"},
         {"synth", "surface", "d.ply", "--points", "0", "--holes", "0", "--points 0"},
         {"synth", "surface", "d.ply", "--points", "400", "--holes", "90", "--holes 90"},
         {"synth", "surface", "d.ply", "--kind", "sphere", "--density-step", "4", "--density-step"},
         {"synth", "surface", "d.ply", "--positions", "random", "--jitter", "0.1", "--jitter"},
         {"synth", "scan", "d.ply", "--stations", "0", "--stations"},
         {"synth", "scan", "d.ply", "--truth", "d.ply", "two files"},
         {"make", "all", "--output", "d", "unknown option --output; the names of files need no option"},
         {"synth", "surface", "-o", "d.ply", "unknown option -o; the names of files need no option"},
         {"synth", "surface", "-V", "unknown option -V; it has no command before it: lacuna-bench -V"},
         {"evaluate", "RESULT"},
         {"evaluate", "a", "TRUTH"},
         {"evaluate", "a", "b", "--tolerance", "-1", "--tolerance"},
         {"evaluate", "a", "b", "--min-vertices", "-1", "--min-vertices"}},
        [](const Words& words) { return run_bench(words); });
  for (const char* name : {"d", "x.las", "x.jpg"}) CHECK_FALSE(fs::exists(name));
}

TEST_CASE("a value with a unit or a decimal comma is refused with what a number is") {
  const std::string form = "a number without a unit, with a decimal point";
  for (const std::string value : {"5cm", "0.1m", "0,5"}) {
    check_failure(run_program({"detect", "a.ply", "--out", "d", "--min-hole", value}), 2, form);
    check_failure(run_bench({"synth", "surface", "d.ply", "--spacing", value}), 2, form);
    check_failure(run_bench({"synth", "scan", "d.ply", "--field-of-view", "-30", value}), 2, form);
    check_failure(run_program({"render", "d", "--out", "d.png", "--hide-above", value}), 2, form);
    check_failure(run_bench({"evaluate", "d", "d.txt", "--tolerance", value}), 2, form);
  }
  CHECK_THAT(run_program({"detect", "a.ply", "--out", "d", "--min-hole", "-1"}).err, !Contains(form));
}

TEST_CASE("standard input as a scan is an error that says what to do") {
  check_failure(run_program({"detect", "-", "--out", "d"}), 1, "save it in a file");
  check_failure(run_program({"info", "-"}), 1, "standard input is not read");
  CHECK_FALSE(fs::exists("d"));
}

TEST_CASE("a config is found by the name that it is installed with") {
  const ProgramResult named = run_program({"detect", "--print-config", "--config", "aerial"});
  const std::string file = LACUNA_SOURCE_DIR "/configs/aerial.toml";
  CHECK(named.exit_code == 0);
  CHECK(named.out == run_program({"detect", "--print-config", "--config", file}).out);
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

TEST_CASE("a run creates its folder, prints what it found unless it is quiet, and leaves nothing else") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(40));
  const fs::path out = scratch / "new/folder", picture = scratch / "pictures/new/a.png";
  const ProgramResult result =
      run_program({"detect", scan, "--out", out.string(), "--scratch", (scratch / "temporary").string()});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("1,500 points") && Contains("peak memory") && Contains("points/s") &&
                             Contains("largest holes") && Contains((out / "holes.json").string()));
  CHECK_THAT(result.err, Contains("done in") && !Contains("\r"));
  CHECK(count_entries(out) == 6);                  // and no workspace
  CHECK_FALSE(fs::exists(scratch / "temporary"));  // made for the run, empty after it
  const ProgramResult quiet = run_program({"detect", scan, "--out", out.string(), "--quiet"});
  CHECK((quiet.exit_code == 0 && quiet.out.empty() && quiet.err.empty()));
  for (const bool has_results : {false, true}) {
    const std::string results = has_results ? out.string() : "none";
    CHECK((run_program({"render", results, "--out", picture.string()}).exit_code == 0) == has_results);
    CHECK(fs::exists(scratch / "pictures") == has_results);
  }
}

TEST_CASE("a signal while results replace older ones leaves the older ones or all new ones") {
  const ScratchFolder scratch;
  const std::string scan = scratch.write("scan.txt", sheet(300));
  const fs::path out = scratch / "out";
  const Words arguments = {"detect",          scan,  "--out",    out.string(), "--points",
                           "--points-format", "ply", "--report", "--quiet"};
  REQUIRE(run_program(arguments).exit_code == 0);
  const std::string before = read_file(out / "holes.json");
  const auto is_writing = [&] { return fs::exists(temporary_of(out) / "results/holes.json"); };
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const auto written = fs::last_write_time(out / "holes.json");
    const ProgramResult result = run_program_until(arguments, signal, is_writing);
    for (const char* name : {"loops.ply", "boundary.ply", "points.ply", "report.html"})
      CHECK(fs::exists(out / name));
    const std::string after = read_file(out / "holes.json");
    CHECK(after == before);
    if (fs::last_write_time(out / "holes.json") != written) {  // a busy machine: all new ones were in place
      if (result.exit_code == 128 + signal && signal != SIGKILL)
        CHECK(result.err == "lacuna: interrupted; the results in " + out.string() + " are complete\n");
      continue;
    }
    CHECK(result.exit_code == 128 + signal);
    if (signal != SIGKILL) CHECK(result.err == "lacuna: interrupted; " + out.string() + " is as it was\n");
    CHECK(count_entries(out) == 8);
    CHECK(temporary_of(out).empty() == (signal != SIGKILL));
  }
}

TEST_CASE("a signal while a scan is made leaves nothing") {
  const ScratchFolder scratch;
  const auto is_writing = [&] { return !fs::is_empty(scratch.path()); };
  const ProgramResult result =
      run_program_until({"synth", "surface", (scratch / "made.ply").string(), "--points", "20000000"}, SIGINT,
                        is_writing, Program::kBench);
  CHECK(result.exit_code == 128 + SIGINT);
  CHECK(result.err == "lacuna-bench: interrupted\n");
  CHECK(fs::is_empty(scratch.path()));
}

TEST_CASE("info reads a LAS file whose columns leave no room for results") {
  const ScratchFolder scratch;
  LasFile las{.minor = 2, .format = 0};
  std::string descriptors;
  for (int i = 0; i < 340; ++i) descriptors += las_extra_descriptor(std::to_string(i), 1);
  las.records = {las_record("LASF_Spec", 4, descriptors)};
  for (int i = 0; i < 100; ++i) las.points.push_back(las_point(20 + 340, i % 10, i / 10, 0));
  const std::string scan = scratch.write("wide.las", las.bytes());
  const ProgramResult info = run_program({"info", scan});
  CHECK(info.exit_code == 0);
  check_failure(run_program({"detect", scan, "--points", "--out", (scratch / "out").string()}), 1,
                "--points-format ply holds them all");
}

TEST_CASE("info prints what files hold and what a run would take, and writes nothing") {
  const ScratchFolder scratch;
  const std::string text = scratch.write("scan.txt", sheet(8));
  const std::string ply =
      scratch.write("one.ply", ascii_ply("100 0 -5 7\n", kWideXyz + "property uchar red\n"));
  CHECK_THAT(run_program({"info", text, ply}).out,
             Contains("PLY, ascii") && Contains("red (uchar)") && Contains("points        61"));
  for (const char* columns : {"z y x", "z,y,x"})
    CHECK(run_program({"info", "--columns", columns, text}).exit_code == 0);
  const auto root = json_of(run_program({"info", text, ply, "--json"}).out);
  CHECK(root.at("points") == 61);
  CHECK(root.at("files").at(0).at("format") == "text");
  CHECK(root.at("files").at(1).at("points") == 1);
  CHECK(root.at("files").at(1).at("properties").at(3).at("type") == "uchar");
  CHECK(root.at("bounds").at("max").at(0) == 100);
  CHECK(root.at("bounds").at("min").at(2) == -5);
  CHECK(scratch.names() == Words{"one.ply", "scan.txt"});
}

}  // namespace
}  // namespace lacuna::test
