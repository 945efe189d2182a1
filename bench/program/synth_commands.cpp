// SPDX-License-Identifier: Apache-2.0
// The commands that make scans with known holes: `synth` one, `make` a folder of them for `score`.
#include "bench/program/commands.hpp"
#include "bench/synth/scan.hpp"
#include "bench/synth/surface.hpp"
#include "engine/run/error.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace lacuna::bench {

using namespace tools;
using namespace io;
using namespace synth;
namespace fs = std::filesystem;

namespace {

// ---- synth

// Adds an option whose words are the values of T, in order.
template <class T, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option,
                        const std::array<std::string_view, N>& words, T& value, const std::string& help) {
  return tools::add_choice(
      command, option, words, [&value](std::size_t place) { value = static_cast<T>(place); }, help);
}

constexpr std::array<std::string_view, 7> kKinds{"plane",      "waves",  "cylinder", "torus",
                                                 "sphere-cap", "sphere", "cube"};
constexpr std::array<std::string_view, 2> kPositions{"jittered", "random"}, kOrders{"scanline", "random"};
constexpr std::array<std::string_view, 7> kScenes{"room",   "court", "hall",  "vault",
                                                  "street", "plant", "aerial"};

template <class Options>
struct Arguments {
  Options options;
  bool as_double = false, overwrite = false;

  Options chosen() const {
    Options chosen = options;
    if (as_double) chosen.coordinates = Coordinates::kDouble;
    if (overwrite) chosen.overwrite = Overwrite::kAny;
    return chosen;
  }
};

// The options that both kinds of scan have.
template <class Options>
void add_common(CLI::App& app, Arguments<Options>& arguments) {
  Options& options = arguments.options;
  app.add_option("OUT", options.out, "the PLY file to write, binary little-endian; its name ends in .ply")
      ->type_name("FILE")
      ->check(name_ending_in(".ply"))
      ->required();
  app.add_option("--truth", options.truth, "file of the true loops, 0-based point ids")
      ->type_name("FILE")
      ->default_str("OUT.loops.txt");
  app.add_option("--points", options.points, "about how many points")
      ->check(whole_number())
      ->capture_default_str();
  add_choice(app, "--order", kOrders, options.order, "the order of the points in the file")
      ->default_str("scanline");
  app.add_option("--seed", options.seed, "same seed and options, same bytes; any whole number")
      ->check(whole_number())
      ->capture_default_str();
  app.add_option("--translate", options.translate, "moves the scan, units of the scan")
      ->check(real_number())
      ->type_name("X Y Z")
      ->default_str("0 0 0");
  app.add_flag("--double", arguments.as_double, "write coordinates as double instead of float");
  app.add_flag("--overwrite", arguments.overwrite,
               "replace files that lacuna-bench synth did not write, too");
}

void add_surface(CLI::App& synth) {
  CLI::App& app = *synth.add_subcommand("surface", "A surface with holes, and their true loops");
  const auto arguments = std::make_shared<Arguments<SurfaceOptions>>();
  SurfaceOptions& o = arguments->options;
  add_common(app, *arguments);
  add_choice(app, "--kind", kKinds, o.kind, "the shape of the surface")->default_str("plane");
  app.add_option("--spacing", o.spacing, "mean distance of neighbours, units of the scan")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--holes", o.holes, "how many holes to plant")->check(whole_number())->capture_default_str();
  app.add_option("--hole-radius", o.hole_radius,
                 "smallest and largest radius of a hole, spacings, from 1.5 on")
      ->check(real_number())
      ->type_name("MIN MAX")
      ->default_str("4 12");
  add_choice(app, "--positions", kPositions, o.positions,
             "near the nodes of a grid, or anywhere on the surface with the same density")
      ->default_str("jittered");
  CLI::Option* const jitter =
      app.add_option("--jitter", o.jitter,
                     "how far a point may be off its grid node, fraction of the spacing, 0 to 0.5")
          ->check(real_number())
          ->capture_default_str();
  app.add_option("--noise", o.noise, "Gaussian noise along the normal, standard deviation in spacings")
      ->check(real_number())
      ->capture_default_str();
  app.add_option(
         "--density-step", o.density_step,
         "one half has 1/F of the density: every 2nd (3rd, ...) row and column for F = 4 (9, ..., 100)")
      ->check(whole_number())
      ->capture_default_str();
  app.add_option("--density-factor", o.density_factor,
                 "the density changes smoothly over the surface by this factor, 1 to 100")
      ->check(real_number())
      ->capture_default_str();
  app.callback([arguments, jitter] {
    const SurfaceOptions options = arguments->chosen();
    if (options.positions == PositionKind::kRandom && jitter->count() > 0)
      throw UsageError(
          "--jitter: random positions have no grid to be off; allowed with --positions jittered");
    const Made made = write_surface(options);
    std::cout << visible(options.out.string()) << ": " << made.points << " points; "
              << visible(made.truth.string()) << ": " << made.loops << " true loops\n";
  });
}

void add_scan(CLI::App& synth) {
  CLI::App& app =
      *synth.add_subcommand("scan", "A scene as laser scanners measure it, in metres, and its true loops");
  const auto arguments = std::make_shared<Arguments<ScanOptions>>();
  ScanOptions& o = arguments->options;
  add_common(app, *arguments);
  add_choice(app, "--scene", kScenes, o.scene, "what is scanned; aerial: from the air")->default_str("room");
  app.add_option("--stations", o.stations, "from how many places, or in how many strips or lanes, 1 to 255")
      ->check(whole_number())
      ->capture_default_str();
  app.add_flag("--drive", o.drives,
               "the scanner drives along x, in so many lanes as --stations says, and turns around its path");
  app.add_option("--station-factor", o.station_factor,
                 "points of the first station over those of each other one, 0.01 to 100")
      ->check(real_number())
      ->capture_default_str();
  app.add_option(
         "--sweeps", o.sweeps,
         "sweeps of each station, 1 to 8; several are tilted by 25 degrees, so that their lines cross")
      ->check(whole_number())
      ->capture_default_str();
  app.add_option("--noise", o.noise, "Gaussian noise along the ray, standard deviation in metres")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--outliers", o.outliers, "fraction of the points that lie anywhere on their ray, 0 to 1")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--registration", o.registration,
                 "error of the place of each station after the first, standard deviation in metres")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--max-range", o.max_range, "what is farther returns nothing, metres; not from the air")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--ring-ratio", o.ring_ratio,
                 "step of elevation over step of azimuth, 0.01 to 100; a spinning scanner with few beams has "
                 "5 or more")
      ->check(real_number())
      ->capture_default_str();
  app.add_option("--field-of-view", o.field_of_view,
                 "lowest and highest elevation, degrees; not of a moving scanner")
      ->check(real_number())
      ->type_name("LOW HIGH")
      ->default_str("-60 90");
  app.callback([arguments] {
    const ScanOptions options = arguments->chosen();
    const Made made = write_scan(options);
    std::cout << visible(options.out.string()) << ": " << made.points << " points of " << made.rays
              << " rays; " << visible(made.truth.string()) << ": " << made.loops << " true loops\n";
  });
}

// ---- make

// A cloud's kind is its name up to the first hyphen (score_commands.cpp).
template <class Options>
struct Cloud {
  std::string_view name;
  Options options;  // all but files, points and seed
};

// Each cloud of each set has a seed of its own.
constexpr std::uint64_t kFirstSeed = 301, kSeedsOfSet = 1000;
constexpr std::uint64_t kSurfacePoints = 40'000, kScanPoints = 150'000;

std::vector<Cloud<SurfaceOptions>> surfaces() {
  using enum SurfaceKind;
  using enum PositionKind;
  return {{"surface-plane", {.kind = kPlane}},
          {"surface-waves", {.kind = kWaves, .density_factor = 4}},
          {"surface-cylinder", {.kind = kCylinder, .density_step = 4}},
          {"surface-torus", {.kind = kTorus}},
          {"surface-cap", {.kind = kSphereCap}},
          {"random-plane", {.kind = kPlane, .positions = kRandom}},
          {"random-waves", {.kind = kWaves, .positions = kRandom}},
          {"random-torus", {.kind = kTorus, .positions = kRandom, .noise = 0.25}},
          {"noise-plane", {.kind = kPlane, .noise = 0.5}},
          {"noise-waves", {.kind = kWaves, .noise = 0.5}},
          {"noise-torus", {.kind = kTorus, .positions = kRandom, .noise = 0.5}},
          {"closed-sphere", {.kind = kSphere, .holes = 0}},
          {"closed-torus", {.kind = kTorus, .holes = 0, .positions = kRandom}},
          {"closed-cube", {.kind = kCube, .holes = 0, .noise = 0.25}}};
}

std::vector<Cloud<ScanOptions>> scans() {
  using enum SceneKind;
  return {{"station-room", {.scene = kRoom, .stations = 1}},
          {"station-court", {.scene = kCourt, .stations = 1}},
          {"station-vault", {.scene = kVault, .stations = 1}},
          {"lidar-room", {.scene = kRoom, .stations = 3, .registration = 0.005}},
          {"lidar-court", {.scene = kCourt, .stations = 2}},
          {"lidar-hall", {.scene = kHall, .stations = 2}},
          {"lidar-plant", {.scene = kPlant, .stations = 3}},
          {"rings-court", {.scene = kCourt, .stations = 3, .ring_ratio = 5}},
          {"rings-street", {.scene = kStreet, .stations = 3, .ring_ratio = 5}},
          {"aerial-even", {.scene = kAerial, .stations = 4, .noise = 0.03}},
          {"aerial-steps", {.scene = kAerial, .stations = 3, .station_factor = 5, .noise = 0.05}},
          {"noise-room", {.scene = kRoom, .stations = 2, .noise = 0.03}},
          {"noise-street", {.scene = kStreet, .stations = 3, .noise = 0.05}}};
}

enum class CloudSet { kSurfaces, kScans, kAll };
constexpr std::array<std::string_view, 3> kSets{"surfaces", "scans", "all"};

struct MakeArguments {
  CloudSet set = CloudSet::kAll;
  fs::path folder;
  std::uint64_t seed = 1;
};

struct Totals {
  std::uint64_t clouds = 0, points = 0, loops = 0;
};

template <class Options, class Write>
void make(const std::vector<Cloud<Options>>& clouds, std::uint64_t points, const MakeArguments& arguments,
          const Write& write, Totals& made) {
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    Options options = clouds[i].options;
    options.out = arguments.folder / (std::string(clouds[i].name) + ".ply");
    options.points = points;
    options.seed = kFirstSeed + kSeedsOfSet * (arguments.seed - 1) + i;  // modulo 2^64
    const auto summary = write(options);
    ++made.clouds;
    made.points += summary.points;
    made.loops += summary.loops;
  }
}

void run_make(const MakeArguments& arguments) {
  std::error_code failure;
  fs::create_directories(arguments.folder, failure);
  if (failure) throw Error(arguments.folder.string() + ": cannot be made: " + failure.message());
  Totals made;
  if (arguments.set != CloudSet::kScans) make(surfaces(), kSurfacePoints, arguments, write_surface, made);
  if (arguments.set != CloudSet::kSurfaces) {
    make(
        scans(), kScanPoints, arguments, [](const ScanOptions& o) { return write_scan(o); }, made);
  }
  std::cout << visible(arguments.folder.string()) << ": " << print_count(made.clouds) << " clouds of "
            << print_count(made.points) << " points, and " << print_count(made.loops) << " true loops (seed "
            << arguments.seed << ")\n";
}

}  // namespace

void add_synth_command(CLI::App& program) {
  CLI::App& synth = *program.add_subcommand("synth", "Generate a synthetic scan whose true loops are known");
  synth.require_subcommand(1);
  add_surface(synth);
  add_scan(synth);
}

void add_make_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("make", "Make a folder of clouds whose holes are known, for `score`");
  const auto arguments = std::make_shared<MakeArguments>();
  add_choice(command, "SET", kSets, arguments->set, "surfaces, scans or all: which clouds")->required();
  command.add_option("DIR", arguments->folder, "the folder for X.ply and X.loops.txt of each cloud X")
      ->required();
  command.add_option("--seed", arguments->seed, "Another seed makes other clouds of the same kinds")
      ->check(whole_number())
      ->capture_default_str();
  command.callback([arguments] { run_make(*arguments); });
}

}  // namespace lacuna::bench
