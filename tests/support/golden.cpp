// SPDX-License-Identifier: Apache-2.0
#include "tests/support/golden.hpp"

#include "io/read/scan/scan_pass.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
using namespace io;

std::optional<fs::path> shared_folder() {
  const char* named = std::getenv("LACUNA_SHARED");
  const fs::path folder = named ? fs::path(named) : fs::path(LACUNA_SOURCE_DIR).parent_path() / "shared";
  if (!fs::is_directory(folder)) {
    test::skip(folder.string() + " is not there");
    return std::nullopt;
  }
  return folder;
}

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

GoldenLoops read_golden_loops(const fs::path& shared, const GoldenSetting& setting) {
  std::ifstream file(shared / "golden" / (setting.name + ".loops.txt"));
  if (!file) throw std::runtime_error(setting.name + ": no golden loops");
  GoldenLoops loops;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream ids(line);
    loops.emplace_back();
    for (std::uint64_t id; ids >> id;) loops.back().push_back(PointId{id});
  }
  return loops;
}

Cloud read_cloud(const fs::path& file) {
  const ScanFiles scan({file}, {});
  ScanPass pass(scan);
  return read_points(pass);
}

}  // namespace lacuna
