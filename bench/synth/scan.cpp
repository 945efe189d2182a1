// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scan.hpp"

#include "bench/synth/scan_truth.hpp"
#include "bench/synth/scanner.hpp"
#include "bench/synth/truth_file.hpp"
#include "engine/run/error.hpp"
#include "io/read/files/number.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::synth {
using namespace io;

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw UsageError(message);
}

void check(const ScanOptions& o) {
  require(o.points >= 1 && o.points <= 1'000'000'000'000, "--points: must be 1 to 1e12");
  require(o.stations >= 1 && o.stations <= 255, "--stations: must be 1 to 255");
  require(o.noise >= 0 && o.noise <= 10, "--noise: must be 0 to 10 metres");
  require(o.outliers >= 0 && o.outliers <= 1, "--outliers: must be 0 to 1");
  require(o.registration >= 0 && o.registration <= 1, "--registration: must be 0 to 1 metre");
  require(o.max_range >= 1 && o.max_range <= 1e6, "--max-range: must be 1 to 1e6 metres");
  require(o.ring_ratio >= 0.01 && o.ring_ratio <= 100, "--ring-ratio: must be 0.01 to 100");
  require(
      o.field_of_view[0] >= -90 && o.field_of_view[0] + 1 <= o.field_of_view[1] && o.field_of_view[1] <= 90,
      "--field-of-view: needs -90 <= lowest < highest <= 90 degrees, 1 degree apart");
  require(o.station_factor >= 0.01 && o.station_factor <= 100, "--station-factor: must be 0.01 to 100");
  require(o.sweeps >= 1 && o.sweeps <= 8, "--sweeps: must be 1 to 8");
  for (const double offset : o.translate) {
    require(std::fabs(offset) <= 1e12, "--translate: must be within 1e12 metres");
    require(o.coordinates == Coordinates::kDouble || std::fabs(offset) <= 10'000,
            "--translate: floats are too coarse that far out; add --double");
  }
}

constexpr std::string_view kStationsMark = "# stations of a synthetic scan: name x y z source\n";

constexpr std::string_view kTrajectoryMark = "# trajectory of a synthetic scan\ntime x y z\n";

void append_place(std::string& line, Vec3 place, const ScanOptions& options) {
  const auto [x, y, z] = options.translate;
  for (const double coordinate : {place.x + x, place.y + y, place.z + z}) {
    line += ' ';
    append_shortest(line, coordinate);
  }
}

// Writes places as `--stations` of lacuna detect reads them.
void write_stations(const Scanner& scanner, const ScanOptions& options, OutputFile& file) {
  file.write(kStationsMark);
  for (std::size_t i = 0; i < scanner.stations().size(); ++i) {
    std::string line = "station_" + std::to_string(i);
    append_place(line, scanner.stations()[i], options);
    file.write(line + " " + std::to_string(i) + "\n");
  }
}

// Each strip has a place for every metre.
void write_trajectory(const Scanner& scanner, const ScanOptions& options, OutputFile& file) {
  file.write(kTrajectoryMark);
  const double length = scanner.strip_length();
  const double steps = std::ceil(std::min(length, 1000.0));
  for (const Sweep& strip : scanner.sweeps()) {
    for (double step = 0; step <= steps; ++step) {
      const double share = step / steps;
      std::string line;
      append_shortest(line, scanner.strip_start(strip.station) + share * length / Scanner::kSpeed);
      append_place(line, strip.origin + (share - 0.5) * length * strip.x, options);
      file.write(line + "\n");
    }
  }
}

void check_movement(const ScanOptions& o) {
  require(o.sweeps == 1, "--sweeps: a moving scanner has one sweep on each strip");
  require(o.field_of_view == kFieldOfView, "--field-of-view: a moving scanner has its own");
}

}  // namespace

ScanSummary write_scan(const ScanOptions& options) {
  return write_scan(options, make_scene(options.scene, options.seed));
}

ScanSummary write_scan(const ScanOptions& options, const Scene& scene) {
  check(options);
  if (scene.flown || options.drives) check_movement(options);
  const std::filesystem::path truth_path = truth_file_of(options.out, options.truth);
  const Scanner scanner(options, scene);
  NewFile truth_output(truth_path, kTruthMark, options.overwrite);
  OutputFile& truth_file = truth_output.content();
  NewFile stations_output(std::filesystem::path(options.out)
                              .replace_extension(scanner.moves() ? ".trajectory.txt" : ".stations.txt"),
                          scanner.moves() ? kTrajectoryMark : kStationsMark, options.overwrite);
  OutputFile& stations = stations_output.content();
  NewFile scan(options.out, kScanMark, options.overwrite);
  PlyOutput ply(scan.content(), options.coordinates, scanner.moves() ? Extras::kScanAndTime : Extras::kScan);
  const std::uint64_t count = scanner.rays();
  ScanTruth truth(scanner, options.points);
  const Permutation shuffled(count, options.seed);

  for (std::uint64_t turn = 0; turn < count; ++turn) {
    const std::uint64_t index = options.order == Order::kRandom ? shuffled(turn) : turn;
    const Ray ray = scanner.ray(index);
    const std::optional<Echo> echo = scanner.measure(ray, index);
    if (!echo) continue;
    truth.note(*echo, index, ply.count());
    ply.add(echo->position, static_cast<std::uint8_t>(scanner.sweeps()[ray.sweep].station),
            static_cast<float>(echo->intensity), scanner.moves() ? scanner.time(ray) : 0);
  }

  const std::vector<NamedLoop> loops = truth.loops();
  write_truth_head(truth_file, options.out);
  for (const NamedLoop& loop : loops) write_loop(truth_file, loop.name, loop.ids);
  for (const auto& narrow : truth.narrow_loops()) write_marked(truth_file, evaluation::kNarrowMark, narrow);
  for (const auto& step : truth.steps()) write_marked(truth_file, evaluation::kStepMark, step);
  scanner.moves() ? write_trajectory(scanner, options, stations) : write_stations(scanner, options, stations);
  ply.finish();
  truth_output.commit();
  stations_output.commit();
  scan.commit();
  return {.points = ply.count(), .rays = count, .loops = loops.size(), .truth = truth_path};
}

}  // namespace lacuna::synth
