// SPDX-License-Identifier: Apache-2.0
#include "bench/program/commands.hpp"
#include "bench/synth/scan.hpp"
#include "bench/synth/surface.hpp"
#include "engine/run/error.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"

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
namespace {

namespace fs = std::filesystem;
using namespace synth;

// A cloud's kind is its name up to the first hyphen (score_command.cpp).
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

struct Made {
  std::uint64_t clouds = 0, points = 0, loops = 0;
};

template <class Options, class Write>
void make(const std::vector<Cloud<Options>>& clouds, std::uint64_t points, const MakeArguments& arguments,
          const Write& write, Made& made) {
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
  Made made;
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

void add_make_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("make", "Make a folder of clouds whose holes are known, for `score`");
  const auto arguments = std::make_shared<MakeArguments>();
  add_choice(
      command, "SET", kSets, [arguments](std::size_t set) { arguments->set = static_cast<CloudSet>(set); },
      "surfaces, scans or all: which clouds")
      ->required();
  command.add_option("DIR", arguments->folder, "the folder for X.ply and X.loops.txt of each cloud X")
      ->required();
  command.add_option("--seed", arguments->seed, "Another seed makes other clouds of the same kinds")
      ->check(whole_number())
      ->capture_default_str();
  command.callback([arguments] { run_make(*arguments); });
}

}  // namespace lacuna::bench
