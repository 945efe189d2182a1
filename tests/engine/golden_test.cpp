// SPDX-License-Identifier: Apache-2.0
// The engine against golden results: of drawn clouds by the plain reference (tests/data), and of real scans
// by another program (../shared/golden).
#include "tests/support/golden.hpp"

#include "io/read/scan/scan_pass.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

using namespace io;

TEST_CASE("the engine gives the golden results of drawn clouds, whatever the tiles") {
  std::map<std::string, std::vector<std::string>> expected;  // by the name of a case
  std::ifstream file(fs::path(LACUNA_SOURCE_DIR) / kGoldenFile);
  for (std::string line; std::getline(file, line);) expected[line.substr(0, line.find(' '))].push_back(line);
  for (const GoldenCase& golden : golden_cases()) {
    for (const std::int64_t tile_points : {20, 150, 100'000}) {
      INFO(golden.name << ", " << tile_points << " points a tile");
      const Detected detected = run_engine(golden.cloud, tiled(golden.config, tile_points));
      GoldenOutcome outcome;
      for (const PointResult& p : detected.points)
        outcome.points.push_back({p.probability, p.coherent != 0, p.boundary != 0});
      const std::vector<std::vector<PointId>> loops = detected.loop_ids();
      for (std::size_t i = 0; i < loops.size(); ++i)
        outcome.loops.push_back({loops[i], detected.loops[i].measures.track.confidence});
      std::istringstream found(golden_lines(golden, outcome));
      std::string line;
      for (const std::string& wanted : expected[golden.name]) {
        std::getline(found, line);
        CHECK(line == wanted);
      }
      CHECK(!std::getline(found, line));
      CHECK(!expected[golden.name].empty());
    }
  }
}

struct GoldenPoint {
  double angle = 0, halfdisc = 0, shape = 0, probability = 0;
  bool coherent = false;
};

struct GoldenSetting {
  std::string name;   // of its files in shared/golden
  std::string cloud;  // file in the shared folder
  Config config;
};

std::vector<GoldenSetting> golden_settings() {
  const Config k15 = with_paper_loops({});
  Config eps = k15, k25 = k15, noisy = k15;
  eps.neighbourhood.eps = 0.004;
  k25.neighbourhood.k = 25;
  noisy.criteria = {.sigma = 0.8, .cone = 25, .weights = {0.2, 0.2, 0.6}};
  noisy.coherence.threshold = 0.4;
  noisy.spanning = {.max_prob_weight = 1.2, .max_total_weight = 2.8, .e = 20};
  return {{"bun_zipper.k15", "data/bun_zipper.ply", k15}, {"bun_zipper.eps0.004", "data/bun_zipper.ply", eps},
          {"bun000.k15", "data/bun000.ply", k15},         {"bun000.k25", "data/bun000.ply", k25},
          {"bun000.noisy", "data/bun000.ply", noisy},     {"tied.k15", "golden/tied.ply", k15},
          {"aerial.k15", "golden/aerial.ply", k15}};
}

std::vector<GoldenPoint> read_golden_points(const fs::path& shared, const GoldenSetting& setting) {
  const std::string file = (shared / "golden" / (setting.name + ".points.csv.gz")).string();
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("gzip -dc '" + file + "'").c_str(), "r"), pclose);
  if (!pipe) throw std::runtime_error("cannot run gzip");
  std::vector<GoldenPoint> points;
  char line[512];
  if (!std::fgets(line, sizeof line, pipe.get())) throw std::runtime_error(file + ": empty");
  while (std::fgets(line, sizeof line, pipe.get())) {
    GoldenPoint p;
    long id, coherent;
    if (std::sscanf(line, "%ld,%lf,%lf,%lf,%lf,%*f,%*d,%ld", &id, &p.angle, &p.halfdisc, &p.shape,
                    &p.probability, &coherent) != 6 ||
        id != long(points.size())) {
      throw std::runtime_error(file + ": bad line: " + line);
    }
    p.coherent = coherent != 0;
    points.push_back(p);
  }
  return points;
}

std::vector<std::vector<PointId>> read_golden_loops(const fs::path& shared, const GoldenSetting& setting) {
  std::ifstream file(shared / "golden" / (setting.name + ".loops.txt"));
  if (!file) throw std::runtime_error(setting.name + ": no golden loops");
  std::vector<std::vector<PointId>> loops;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream ids(line);
    loops.emplace_back();
    for (std::uint64_t id; ids >> id;) loops.back().push_back(PointId{id});
  }
  return loops;
}

Detected detect_file(const fs::path& file, const Config& config) {
  const ScanFiles scan({file}, {});
  ScanPass pass(scan);
  return run_engine(pass, config);
}

TEST_CASE("the engine gives the golden probabilities, coherence and loops, in tiles of 3,000 points") {
  const auto shared = test::shared_folder();
  if (!shared) return;
  for (GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    setting.config.run.tile_points = 3000;
    const Detected detected = detect_file(*shared / setting.cloud, setting.config);
    REQUIRE(detected.points.size() == golden.size());
    std::size_t wrong = 0;
    double largest_error = 0;
    for (std::size_t i = 0; i < golden.size(); ++i) {
      const PointResult& p = detected.points[i];
      const GoldenPoint& g = golden[i];
      wrong += (p.coherent != 0) != g.coherent;
      for (const double error : {p.criteria[0] - g.angle, p.criteria[1] - g.halfdisc, p.criteria[2] - g.shape,
                                 p.probability - g.probability})
        largest_error = std::max(largest_error, std::abs(error));
    }
    CHECK(wrong == 0);
    CHECK(largest_error < 1e-6);
    CHECK(detected.summary.tiles > 1);
    std::vector<std::vector<PointId>> loops = detected.loop_ids();
    std::ranges::sort(loops);
    CHECK(loops == read_golden_loops(*shared, setting));
  }
}

TEST_CASE(
    "the engine finds the paper's figures: the bunny's five holes, the range map's outer curve of 844 "
    "points") {
  const auto shared = test::shared_folder();
  if (!shared) return;
  const Detected bunny = detect_file(*shared / "data/bun_zipper.ply", with_paper_loops({}));
  CHECK(bunny.summary.e == 14);
  REQUIRE(bunny.loops.size() == 5);
  for (const ReportedLoop& loop : bunny.loops) CHECK(loop.measures.kind == LoopKind::kHole);

  Config config = with_paper_loops({});  // figure 15
  config.spanning.e = 500;
  const Detected range_map = detect_file(*shared / "data/bun000.ply", config);
  REQUIRE(range_map.loops.size() == 1);
  CHECK(range_map.loops[0].points.size() == 844);
  CHECK(range_map.loops[0].measures.kind == LoopKind::kOuter);
}

}  // namespace
}  // namespace lacuna
