// SPDX-License-Identifier: Apache-2.0
#include "bench/program/commands.hpp"
#include "bench/synth/scan.hpp"
#include "bench/synth/surface.hpp"
#include "engine/run/error.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace lacuna::bench {
using namespace tools;
using namespace io;

namespace {

using namespace synth;

// Returns a value by its name.
template <class T>
struct Choice {
  std::string_view name;
  T value;
};

template <class T, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option, const std::array<Choice<T>, N>& choices,
                        T& value, const std::string& help) {
  std::array<std::string_view, N> names;
  std::ranges::transform(choices, names.begin(), &Choice<T>::name);
  return tools::add_choice(
      command, option, names, [&choices, &value](std::size_t place) { value = choices[place].value; }, help);
}

constexpr std::array<Choice<SurfaceKind>, 7> kKinds{{{"plane", SurfaceKind::kPlane},
                                                     {"waves", SurfaceKind::kWaves},
                                                     {"cylinder", SurfaceKind::kCylinder},
                                                     {"torus", SurfaceKind::kTorus},
                                                     {"sphere-cap", SurfaceKind::kSphereCap},
                                                     {"sphere", SurfaceKind::kSphere},
                                                     {"cube", SurfaceKind::kCube}}};
constexpr std::array<Choice<PositionKind>, 2> kPositions{
    {{"jittered", PositionKind::kJittered}, {"random", PositionKind::kRandom}}};
constexpr std::array<Choice<SceneKind>, 7> kScenes{{{"room", SceneKind::kRoom},
                                                    {"court", SceneKind::kCourt},
                                                    {"hall", SceneKind::kHall},
                                                    {"vault", SceneKind::kVault},
                                                    {"street", SceneKind::kStreet},
                                                    {"plant", SceneKind::kPlant},
                                                    {"aerial", SceneKind::kAerial}}};
constexpr std::array<Choice<Order>, 2> kOrders{{{"scanline", Order::kScanline}, {"random", Order::kRandom}}};

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
    const SurfaceSummary made = write_surface(options);
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
    const ScanSummary made = write_scan(options);
    std::cout << visible(options.out.string()) << ": " << made.points << " points of " << made.rays
              << " rays; " << visible(made.truth.string()) << ": " << made.loops << " true loops\n";
  });
}

}  // namespace

void add_synth_command(CLI::App& program) {
  CLI::App& synth = *program.add_subcommand("synth", "Generate a synthetic scan whose true loops are known");
  synth.require_subcommand(1);
  add_surface(synth);
  add_scan(synth);
}

}  // namespace lacuna::bench
