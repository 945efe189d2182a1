// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/synth/made.hpp"
#include "tests/support/run_program.hpp"

using namespace lacuna;
using namespace lacuna::synth;

namespace {

// `arguments` are divided by blanks.
void run(const std::string& command, const std::string& out, const std::string& arguments) {
  std::vector<std::string> words = {"synth", command, out, "--truth", out + ".txt"};
  std::istringstream in(arguments);
  for (std::string word; in >> word;) words.push_back(word);
  test::succeed(words, test::Program::kBench);
}

}  // namespace

TEST_CASE("the synth command makes what the options say") {
  const ScratchFolder folder;
  const std::string out = (folder / "made.ply").string();
  run("surface", out,
      "--kind sphere-cap --points 10000 --holes 2 --hole-radius 3 5 --jitter 0.1 --noise 0.1"
      " --spacing 1 --density-factor 2 --order random --seed 9 --translate -5 0 7 --double");
  SurfaceOptions options;
  options.out = folder / "again.ply";
  options.kind = SurfaceKind::kSphereCap;
  options.points = 10'000;
  options.holes = 2;
  options.hole_radius = {3, 5};
  options.jitter = 0.1;
  options.noise = 0.1;
  options.spacing = 1;
  options.density_factor = 2;
  options.order = Order::kRandom;
  options.seed = 9;
  options.translate = {-5, 0, 7};
  options.coordinates = Coordinates::kDouble;
  write_surface(options);
  CHECK(read_file(out) == read_file(options.out));
  CHECK(loops_of(out + ".txt") == loops_of(folder / "again.loops.txt"));
  CHECK(folder.names().size() == 4);

  run("surface", out, "--points 10000 --holes 2 --positions random");
  options = {.out = options.out, .points = 10'000, .holes = 2, .positions = PositionKind::kRandom};
  write_surface(options);
  CHECK(read_file(out) == read_file(options.out));

  run("scan", out,
      "--scene hall --points 5000 --stations 3 --noise 0.01 --outliers 0.1 --max-range 20"
      " --registration 0.03 --ring-ratio 4 --field-of-view -30 60 --sweeps 2 --station-factor 3");
  CHECK(rows_of(out, 17).size() == Approx(5000).epsilon(0.1));
  ScanOptions scan = {.out = options.out, .scene = SceneKind::kHall, .points = 5000, .stations = 3};
  scan.noise = 0.01;
  scan.outliers = 0.1;
  scan.max_range = 20;
  scan.registration = 0.03;
  scan.ring_ratio = 4;
  scan.field_of_view = {-30, 60};
  scan.sweeps = 2;
  scan.station_factor = 3;
  write_scan(scan);
  CHECK(read_file(out) == read_file(scan.out));
  CHECK(loops_of(out + ".txt") == loops_of(folder / "again.loops.txt"));
}
