// SPDX-License-Identifier: Apache-2.0
// Every parameter changes the results of a small scan, or the list says what it needs for that. Each command
// offers the parameters that change what it does, and no others.
#include "io/read/options/options.hpp"
#include "io/read/rows/columns.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/json.hpp"
#include "tests/support/las_file.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/test.hpp"

#include <regex>

namespace lacuna::test {
namespace {

// Another value than the default, for all but flags and the method.
const std::map<std::string_view, std::string_view> kOtherValues = {
    {"normals", "estimated"},
    {"k", "9"},
    {"eps", "4"},
    {"eps_fraction", "0.05"},
    {"crease_threshold", "1"},
    {"sigma", "0.6"},
    {"cone", "40"},
    {"weight_angle", "3"},
    {"weight_halfdisc", "3"},
    {"weight_shape", "3"},
    {"threshold", "0.8"},
    {"max_prob_weight", "0.5"},
    {"max_total_weight", "1.8"},
    {"e", "40"},
    {"seed_probability", "0.99"},
    {"max_radius", "2.5"},
    {"hole_radius", "0.4"},
    {"most_radius", "0.2"},
    {"coarse_bound", "1.25"},
    {"clear_radius", "5"},
    {"added_length", "400"},
    {"min_curve", "40"},
    {"min_confidence", "0.999"},
    {"min_perimeter", "45"},
    {"min_diameter", "15"},
    {"resolution", "0.9"},
    {"min_hole", "7"},
    {"min_points", "40"},
    {"columns", "y x z classification return_number number_of_returns withheld"},
    {"where", "classification == 2"},
    {"trust", "file"},
    {"bounds", "2,2,100,300"},
    {"leave_out", "2,2,-5,30,30,5"},
    {"crs", "EPSG:25832"},
    {"unit", "m"},
    {"unit_z", "ft"},
    {"void_rule", "4"},
    {"except", "water.gpkg"},
    {"classes", "buildings.gpkg"},
    {"area_tile", "50"},
    {"points_format", "ply"},
    {"sample_points", "200"},
    {"coverage", "3"},
    {"stations", LACUNA_SOURCE_DIR "/tests/data/station.txt"},
    {"threads", "3"},
    {"memory_limit", "64MiB"},
    {"tile_points", "150"},
};

std::string_view other_value(std::string_view key) {
  const auto found = kOtherValues.find(key);
  if (found == kOtherValues.end()) FAIL("kOtherValues has no value of " << key);
  return found->second;
}

struct Scan {
  std::string text, noise;  // files
};

// A rough sheet with two holes, and pairs of sheets that join in creases. The points have two classes and
// returns, and one is at 0 0 0. Withheld points make the first hole smaller, and noise the second one. The
// noise is in LAS, since the classes of text are labels.
Scan made_scan() {
  Cloud cloud = plane(32).punched({9, 9}, 2).punched({21, 20}, 5).jittered(0.5, 1).noisy(0.12, 2);
  for (const int degrees : {40, 60, 80, 100, 120})
    cloud = cloud.joined(crease(14, degrees).jittered(0.4, 3).translated({60, 2.0 * degrees, 0}));
  std::ostringstream text;
  text.precision(17);
  text << "x y z classification return_number number_of_returns withheld\n0 0 0 2 1 1 0\n";
  LasFile noise{.scale = {1e-6, 1e-6, 1e-6}, .offset = {0, 0, 0}};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto is_within = [&](double x, double y, double radius) {
      return (cloud.positions[i].head<2>() - Eigen::Vector2d(x, y)).norm() < radius;
    };
    if (is_within(21, 20, 6)) {
      const Eigen::Vector3i steps = (cloud.positions[i] * 1e6).cast<int>();
      noise.points.push_back(las_point(20, steps.x(), steps.y(), steps.z()));
      put(noise.points.back(), 14, std::uint8_t{9});  // the only return
      put(noise.points.back(), 15, std::uint8_t{7});
      continue;
    }
    text << cloud.positions[i].transpose() << (i % 7 == 0 ? " 6" : " 2") << (i % 5 == 0 ? " 2 2" : " 1 1")
         << (is_within(9, 9, 3) ? " 1\n" : " 0\n");
  }
  return {.text = text.str(), .noise = noise.bytes()};
}

class Runs {
 public:
  explicit Runs(const Scan& scan = made_scan()) {
    scratch_.write("scan.txt", scan.text);
    scratch_.write("noise.las", scan.noise);
    scan_ = "@" + scratch_.write("list.txt", "scan.txt\nnoise.las\n");
  }

  // All bytes of the results. Some files have parameters or times in them. Of these it takes the loops of
  // holes.json with their system and unit, and the names of the others.
  std::string results(const io::FilesConfig& config) {
    const std::string file = scratch_.write("c.toml", print_config(config));
    return bytes_of(detect(scan_, scratch_ / ("out-" + std::to_string(runs_++)), {"--config", file}));
  }

  // Returns the same of a run that goes on in the kept folder, or its error.
  std::string kept_results(const io::FilesConfig& config) {
    const std::string file = scratch_.write("c.toml", print_config(config));
    const fs::path out = scratch_ / ("out-" + std::to_string(runs_++));
    const auto run = run_program(
        {"detect", scan_, "--out", out.string(), "--config", file, "--workspace", workspace(), "--quiet"});
    return run.exit_code == 0 ? bytes_of(out) : run.err;
  }
  void forget() const { fs::remove_all(workspace()); }

  // What the program says of these options.
  std::string warnings(std::vector<std::string> options) {
    options.insert(options.begin(), {"detect", scan_, "--out", (scratch_ / "out").string(), "--quiet"});
    const auto run = run_program(options);
    CHECK(run.exit_code == 0);
    return run.err;
  }

  std::string workspace() const { return (scratch_ / "workspace").string(); }
  std::string write(const std::string& config) const { return scratch_.write("given.toml", config); }

 private:
  static std::string bytes_of(const fs::path& out) {
    std::string bytes;
    std::set<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(out))
      if (entry.is_regular_file()) files.insert(entry.path());
    for (const fs::path& file : files) {
      const std::string name = file.filename().string();
      bytes += name;
      if (name != "holes.json" && name != "run.json" && name != "report.html") bytes += read_file(file);
    }
    const auto holes = read_json(out / "holes.json");
    for (const char* key : {"crs", "unit", "loops"}) bytes += holes[key].dump();
    fs::remove_all(out);
    return bytes;
  }

  ScratchFolder scratch_;
  std::string scan_;
  int runs_ = 0;
};

void set_other(const Parameter& parameter, const std::string& workspace) {
  if (bool* const* flag = std::get_if<bool*>(&parameter.value)) {
    **flag = !**flag;
  } else if (parameter.key == "workspace" || parameter.key == "scratch") {
    parameter.set(workspace);
  } else {
    parameter.set(other_value(parameter.key));
  }
}

TEST_CASE("a parameter changes the results unless what it needs is missing or it is about the run",
          "[.slow]") {
  Runs runs;
  struct Setting {
    LoopMethod method;
    bool with_points;
  };
  constexpr Setting kSettings[] = {
      {LoopMethod::kTangential, false}, {LoopMethod::kTangential, true}, {LoopMethod::kPaper, true}};
  // With points there are more results. So an effect without points is one with points, too, and no effect
  // with points is none without.
  const auto follows = [](const Parameter& parameter, LoopMethod method, bool with_points, bool has_effect) {
    const bool needs_points = parameter.key == "points_format" || parameter.key == "points_normals" ||
                              parameter.key == "orient_normals";
    return method == LoopMethod::kTangential && !needs_points && has_effect == with_points;
  };
  for (const auto& [method, with_points] : kSettings) {
    io::FilesConfig config;
    config.loops.method = method;
    config.results.points = config.output.points_normals = with_points;
    const std::string before = runs.results(config);
    const std::size_t count = parameters(config).size();
    for (std::size_t i = 0; i < count; i += count / draws(count)) {
      io::FilesConfig changed = config;
      Parameter parameter = parameters(changed)[i];
      // This scan has neither lines nor normals, and none of its coarse curves stands (curves_test has some).
      // The others say which files are read, and the unit of z needs the unit of x and y. A check reads the
      // section area.
      const std::string_view passed[] = {"method",       "every_point", "normals", "recursive",
                                         "skip_damaged", "unit_z",      "trust",   "coarse_bound"};
      if (std::ranges::count(passed, parameter.key) > 0 || parameter.section == "area") continue;
      set_other(parameter, runs.workspace());
      parameter = parameters(changed)[i];
      const bool has_effect = parameter.missing.empty() && parameter.section != "run";
      if (follows(parameter, method, with_points, has_effect)) continue;
      INFO(name_of(method) << (with_points ? " with points: " : ": ") << parameter.key);
      const std::string after = runs.results(changed);
      CAPTURE(before.size(), after.size(), parameter.print());
      CHECK((after != before) == has_effect);
    }
  }
}

// Runs in a kept folder, then again with one parameter changed, and back. Each run gives the results of a
// fresh one, or is refused.
void check_kept_runs(const io::FilesConfig& config) {
  Scan scan = made_scan();
  std::string& text = scan.text;
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 9) text.insert(at, " 0 0.6 1");
  text.replace(text.find(" 0 0.6 1"), 8, " nx ny nz");
  Runs runs(scan);
  io::FilesConfig counted;
  const std::size_t count = parameters(counted).size();
  for (std::size_t i = 0; i < count; i += count / draws(count)) {
    io::FilesConfig changed = config;
    const Parameter parameter = parameters(changed)[i];
    const std::string_view passed[] = {"workspace", "recursive", "skip_damaged", "unit_z"};
    if (std::ranges::count(passed, parameter.key) > 0 || parameter.section == "area") continue;
    if (parameter.key == "method") {
      changed.loops.method =
          config.loops.method == LoopMethod::kPaper ? LoopMethod::kTangential : LoopMethod::kPaper;
    } else {
      set_other(parameter, runs.workspace() + "-scratch");
    }
    if (!changed.input.columns.empty()) changed.input.columns += " nx ny nz";
    INFO(name_of(config.loops.method) << ", min_hole " << config.scale.min_hole << ": " << parameter.key);
    const std::string fresh = runs.results(changed);
    runs.forget();
    const std::string first = runs.kept_results(config);
    REQUIRE_THAT(first, !Contains("lacuna: error"));
    const std::string kept = runs.kept_results(changed);
    CHECK((kept == fresh));
    CHECK((runs.kept_results(config) == first));  // and back
  }
}

TEST_CASE("a kept run with any other parameter gives the results of a fresh run", "[.slow]") {
  std::vector<io::FilesConfig> configs(3);
  configs[1].loops.method = LoopMethod::kPaper;
  configs[1].results.points = true;
  configs[2].scale.min_hole = 4;
  for (io::FilesConfig& config : configs) {
    config.normals.use = NormalsUse::kGiven;  // they do not fit
    check_kept_runs(config);
  }
}

TEST_CASE("each option without effect has its warning, each other none") {
  Runs runs;
  for (const std::string_view method : {"tangential", "paper"}) {
    io::FilesConfig config;
    config.loops.method = method == "paper" ? LoopMethod::kPaper : LoopMethod::kTangential;
    std::vector<std::string> options{"--method", std::string(method)};
    std::string expected;
    for (const Parameter& parameter : parameters(config)) {
      const bool is_flag = std::holds_alternative<bool*>(parameter.value);
      // The files that the last one changes are wanted.
      const std::set<std::string_view> left_out = {"method",   "points", "columns",       "eps",
                                                   "polygons", "unit_z", "points_format", "resolution"};
      const std::set<std::string_view> sections = {"run", "area"};
      if (parameter.in_file_only || sections.contains(parameter.section) || left_out.contains(parameter.key))
        continue;
      options.push_back(parameter.option());
      if (!is_flag) options.emplace_back(other_value(parameter.key));
      if (!parameter.missing.empty()) {
        expected += "lacuna: warning: " + parameter.option() + " changes nothing without " +
                    std::string(parameter.missing) + "\n";
      }
    }
    CHECK(runs.warnings(options) == expected);
    CHECK_FALSE(expected.empty());
  }
  CHECK(runs.warnings({"--points-format", "ply"}) ==
        "lacuna: warning: --points-format changes nothing without --points\n");
  CHECK(runs.warnings({"--points-format", "ply", "--points"}).empty());
  CHECK(runs.warnings({"--polygons"}) ==
        "lacuna: warning: --polygons changes nothing without --gpkg or --geojson\n");
  CHECK(runs.warnings({"--polygons", "--gpkg"}).empty());
}

TEST_CASE("a config file's value without effect has its warning, unless it is the default") {
  Runs runs;
  const std::string file =
      runs.write("[spanning]\ne = 50\nmax_prob_weight = 1.1\n[coherence]\nthreshold = 0.4\n");
  CHECK(runs.warnings({"--config", file}) ==
        "lacuna: warning: " + file + ": e changes nothing without --method paper\n");
  CHECK(runs.warnings({"--config", file, "--method", "paper"}).empty());
  CHECK(runs.warnings({"--config", runs.write(print_config(io::FilesConfig{}))}).empty());
}

constexpr const char* kCommands[] = {"detect",   "info", "check", "report", "render", "compare",
                                     "stations", "plan", "work",  "finish", "status", "clean"};

// The options that --help-all shows.
std::set<std::string> offered_by(const std::string& command) {
  const std::string help = run_program({command, "--help-all"}).out;
  static const std::regex option("\n  (--[a-z-]+)");
  std::set<std::string> names;
  for (std::sregex_iterator at(help.begin(), help.end(), option); at != std::sregex_iterator(); ++at)
    names.insert((*at)[1]);
  return names;
}

// The sweep of a scanner in files. Some take part with an option alone: withheld points, noise, a damaged
// file, a header with another number, a folder in a folder. One has rays without return, and one has names of
// degrees.
class Sweep {
 public:
  Sweep() {
    const io::ScanFiles scan(
        {synth("scan", scratch_ / "plant.ply", {"--scene", "plant", "--stations", "1", "--points", "6000"})},
        {});
    io::ScanPass pass(scan);
    const std::vector<Eigen::Vector3d> sweep = read_points(pass).positions;
    write("plain.txt", sweep, " 1 1 0\n", "");
    write("origin.txt", sweep, " 1 1 0\n", "0 0 0 2 1 1 0\n");
    write("withheld.txt", sweep, " 1 1 1\n", "");
    LasFile las{.scale = {1e-4, 1e-4, 1e-4}, .offset = {0, 0, 0}};
    for (const Eigen::Vector3d& position : sweep) {
      const Eigen::Vector3i steps = (position * 1e4).cast<int>();
      las.points.push_back(las_point(20, steps.x(), steps.y(), steps.z()));
      put(las.points.back(), 14, std::uint8_t{9});  // the only return
      put(las.points.back(), 15, std::uint8_t{7});
    }
    const std::string bytes = las.bytes();
    scratch_.write("noise.las", bytes);
    scratch_.write("damaged.las", bytes.substr(0, bytes.size() / 2));
    std::string other = bytes;
    put(other, 107, std::uint32_t{5});  // points, by the header
    scratch_.write("other.las", other);
    fs::create_directories(scratch_ / "folder/inside");
    scratch_.write("folder/a.txt", "0 0 0\n1 0 0\n0 1 0\n");
    scratch_.write("folder/inside/b.txt", "3 3 3\n4 3 3\n3 4 3\n");
    scratch_.write("degrees.txt", "longitude latitude z\n1 2 3\n2 2 3\n1 3 3\n");
    for (const auto& [name, corner] : {std::pair{"area", 16}, {"half", 9}, {"water", 7}}) {
      const std::string to = std::to_string(corner);
      scratch_.write(std::string(name) + ".geojson", R"({"type":"Polygon","coordinates":[[[4,4],[)" + to +
                                                         ",4],[" + to + "," + to + "],[4," + to +
                                                         "],[4,4]]]}");
    }
  }

  std::string file(const std::string& name) const { return (scratch_ / name).string(); }

  // What the command prints and writes.
  std::string outcome(const Words& scans, const std::string& command, const Words& options) const {
    Words words{command};
    for (const std::string& scan : scans) words.push_back(file(scan));
    const ProgramResult run = run_program(with(words, options));
    const fs::path voids = scratch_ / "out/voids.json";
    std::string text = std::to_string(run.exit_code) + run.out + run.err;
    if (fs::exists(voids)) text += read_file(voids);
    fs::remove_all(scratch_ / "out");
    return text;
  }

 private:
  // `end` of a row: returns and whether it is withheld. `between`: after every 60th row.
  void write(const std::string& name, const std::vector<Eigen::Vector3d>& sweep, const std::string& end,
             const std::string& between) const {
    std::ostringstream text;
    text.precision(9);
    text << "x y z classification return_number number_of_returns withheld\n";
    for (std::size_t i = 0; i < sweep.size(); ++i)
      text << sweep[i].transpose() << (i % 7 == 0 ? " 6" : " 2") << end << (i % 60 == 0 ? between : "");
    scratch_.write(name, text.str());
  }

  ScratchFolder scratch_;
};

TEST_CASE("each command refuses the parameters that it does not offer, and a run offers all but an area's") {
  io::FilesConfig config;
  std::map<std::string, std::set<std::string>> offered;
  for (const char* command : kCommands) offered[command] = offered_by(command);
  std::size_t next = 0;
  for (const Parameter& parameter : parameters(config)) {
    if (parameter.in_file_only) continue;
    const std::string option = parameter.option();
    INFO(option);
    for (const char* command : {"detect", "plan"})
      CHECK(offered[command].contains(option) == (parameter.section != "area"));
    const bool is_of_process = parameter.changes == Changes::kProcess;
    for (const char* command : {"work", "finish"}) CHECK(offered[command].contains(option) == is_of_process);
    for (const char* command : {"report", "stations", "status", "clean"})
      CHECK_FALSE(offered[command].contains(option));
    CHECK(offered["render"].contains(option) == (option == "--memory-limit"));
    CHECK(offered["compare"].contains(option) == (option == "--report"));  // its own, of both results
    while (offered[kCommands[next % std::size(kCommands)]].contains(option)) ++next;
    const std::string command = kCommands[next++ % std::size(kCommands)];
    check_failure(run_program({command, option}), 2, "unknown option " + option);
  }
  const std::string help = run_program({"check", "--help"}).out;
  CHECK_THAT(help, Contains("too: one sheet with the answer and a map"));
  for (const char* option :
       {"--area", "--void-rule", "--except", "--classes", "--area-tile", "--where", "--out"})
    CHECK_THAT(help, Contains(option));
}

TEST_CASE("each parameter that info or check offers changes what it does", "[.slow]") {
  const Sweep sweep;
  const Words all = {"plain.txt", "origin.txt", "withheld.txt", "noise.las"};
  // Options that a parameter needs, and other files that it changes.
  const std::map<std::string_view, Words> needed = {{"unit_z", {"--unit", "m"}}};
  const std::map<std::string_view, Words> scans = {{"trust", {"plain.txt", "other.las"}},
                                                   {"recursive", {"folder"}},
                                                   {"skip_damaged", {"plain.txt", "damaged.las"}},
                                                   {"unit", {"degrees.txt"}}};
  const std::map<std::string_view, std::string> values = {{"crs", "EPSG:4326"},
                                                          {"area", sweep.file("half.geojson")},
                                                          {"except", sweep.file("water.geojson")},
                                                          {"stations", std::string(other_value("stations"))},
                                                          {"classes", sweep.file("water.geojson")},
                                                          {"scratch", sweep.file("plain.txt")}};
  // They divide the work, or bound its memory.
  const std::set<std::string> silent = {"check --threads"};
  std::map<std::tuple<std::string, Words, Words>, std::string> plain;
  for (const std::string command : {"info", "check"}) {
    const std::set<std::string> offered = offered_by(command);
    io::FilesConfig config;
    for (const Parameter& parameter : parameters(config)) {
      const std::string option = parameter.option();
      if (!offered.contains(option) || silent.contains(command + " " + option)) continue;
      Words options = needed.contains(parameter.key) ? needed.at(parameter.key) : Words();
      if (command == "check") {
        Words area{"--out", sweep.file("out")};
        if (parameter.key != "area") area = with(area, {"--area", sweep.file("area.geojson")});
        if (parameter.key != "void_rule") area = with(area, {"--void-rule", "3"});
        options = with(options, area);
      }
      Words changed = options;
      changed.push_back(option);
      if (values.contains(parameter.key)) {
        changed.push_back(values.at(parameter.key));
      } else if (!std::holds_alternative<bool*>(parameter.value)) {
        changed.emplace_back(other_value(parameter.key));
      }
      INFO(command << " " << option);
      const Words& files = scans.contains(parameter.key) ? scans.at(parameter.key) : all;
      const auto [before, is_new] = plain.try_emplace({command, files, options});
      if (is_new) before->second = sweep.outcome(files, command, options);
      CHECK(sweep.outcome(files, command, changed) != before->second);
    }
  }
  CHECK_THAT(sweep.outcome({"plain.txt"}, "check",
                           {"--area", sweep.file("area.geojson"), "--void-rule", "3", "--area-tile", "5"}),
             Contains("--area-tile changes nothing without --out"));
}

TEST_CASE("a config file serves all commands: keys that one does not read are checked, and change nothing") {
  const Sweep sweep;
  const auto info = [&](const std::string& text) {
    const ScratchFolder scratch;
    return sweep.outcome({"plain.txt"}, "info", {"--config", scratch.write("c.toml", text)});
  };
  const std::string plain = sweep.outcome({"plain.txt"}, "info", {});
  CHECK(info("[output]\npoints_format = \"ply\"\nreport = true\n[selection]\nmin_points = 3\n"
             "[neighbourhood]\neps = 1.0\neps_fraction = 0.1\n[area]\nexcept = \"none.gpkg\"\n") == plain);
  CHECK(info("[scale]\nmin_hole = 7.0\n") != plain);
  CHECK_THAT(info("[output]\nreports = true\n"), Contains("did you mean \"report\"?"));
  CHECK_THAT(info("[selection]\nmin_confidence = 7\n"), Contains("min_confidence = 7"));
}

}  // namespace
}  // namespace lacuna::test
