// SPDX-License-Identifier: Apache-2.0
#include "tests/support/made_golden.hpp"

#include "tests/support/reference.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace lacuna {
namespace {

constexpr double kStep = 1. / 4096;  // of coordinates: exact in few digits

std::map<std::string, Cloud> draw_clouds() {
  const Cloud ball = sphere(300).scaled(5).translated({45, 0, 4});
  const Cloud island = plane(3).translated({60, 60, 0});
  return {{"punched", plane(34).punched({9, 9}, 4).punched({22, 21}, 6).jittered(0.25, 3).noisy(0.05, 4)},
          {"tied", density_step(36).punched({9, 20}, 4.5).with_duplicates(60, 5).shuffled(6)},
          {"rough",
           scattered(1100, 7).scaled(33).punched({12, 12}, 4).noisy(0.15, 8).translated({5e5, 54e5, 3e2})},
          {"shapes",
           open_cylinder(30, 14).joined(crease(14).translated({20, 0, 0})).joined(ball).joined(island)}};
}

Config other_setting(const std::string& cloud) {
  Config config;
  if (cloud == "punched") config.neighbourhood.k = 25;
  if (cloud == "tied") config.neighbourhood.eps = 3;  // grid points lie at exactly this distance
  if (cloud == "rough") {
    config.criteria = {.sigma = 0.8, .cone = 25, .weights = {0.2, 0.2, 0.6}};
    config.coherence.threshold = 0.4;
    config.spanning = {.max_prob_weight = 1.2, .max_total_weight = 2.8, .e = 20};
  }
  if (cloud == "shapes") {
    config.neighbourhood.k = 9;
    config.normals.crease_threshold = 0.3;
    config.selection.min_confidence = 0.2;
  }
  return config;
}

std::ofstream created(const std::filesystem::path& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  return out;
}

std::ifstream opened(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return in;
}

void write_cloud(const std::filesystem::path& file, const Cloud& cloud) {
  std::ofstream out = created(file);
  out.precision(17);
  out << "x y z\n";
  for (const Eigen::Vector3d& p : cloud.positions) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
}

void write_outcome(const std::filesystem::path& file, const GoldenOutcome& outcome) {
  std::ofstream out = created(file);
  out << "# Loops, one a line: \"loop\" and its ids. Then a line for each point: its probability times "
         "2^24,\n"
         "# \"c\" where it is coherent, \"b\" where it is a boundary point.\n";
  for (const std::vector<PointId>& loop : outcome.loops) {
    out << "loop";
    for (const PointId id : loop) out << ' ' << value(id);
    out << '\n';
  }
  for (const GoldenOutcome::Point& p : outcome.points)
    out << p.probability << (p.coherent ? " c" : "") << (p.boundary ? " b" : "") << '\n';
}

}  // namespace

std::vector<GoldenCase> golden_cases() {
  std::vector<GoldenCase> cases;
  for (const std::string cloud : {"punched", "tied", "rough", "shapes"}) {
    const Config other = other_setting(cloud);
    cases.push_back({cloud, "default", {}});
    cases.push_back({cloud, "other", other});
    cases.push_back({cloud, "paper", with_paper_loops({})});
    cases.push_back({cloud, "paper-other", with_paper_loops(other)});
  }
  return cases;
}

GoldenOutcome plain_outcome(const Cloud& cloud, const Config& config) {
  const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
  GoldenOutcome outcome;
  for (const reference::Point& p : plain.points)
    outcome.points.push_back({std::uint32_t(std::lround(p.probability * 0x1p24)), p.coherent, p.boundary});
  outcome.loops = plain.loops;
  std::sort(outcome.loops.begin(), outcome.loops.end());
  return outcome;
}

std::filesystem::path golden_folder() {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / "tests/data";
}

Cloud read_golden_cloud(const std::string& name) {
  std::ifstream in = opened(golden_folder() / (name + ".xyz"));
  std::string line;
  std::getline(in, line);  // names of the columns
  Cloud cloud;
  for (Eigen::Vector3d p; in >> p.x() >> p.y() >> p.z();) cloud.positions.push_back(p);
  return cloud;
}

GoldenOutcome read_golden_outcome(const GoldenCase& golden) {
  std::ifstream in = opened(golden_folder() / (golden.name() + ".txt"));
  GoldenOutcome outcome;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    if (line.starts_with("loop")) {
      words.ignore(4);
      outcome.loops.emplace_back();
      for (std::uint64_t id; words >> id;) outcome.loops.back().push_back(PointId{id});
      continue;
    }
    GoldenOutcome::Point point;
    words >> point.probability;
    for (char flag; words >> flag;) (flag == 'c' ? point.coherent : point.boundary) = true;
    outcome.points.push_back(point);
  }
  return outcome;
}

void make_golden() {
  for (const auto& [name, cloud] : draw_clouds())
    write_cloud(golden_folder() / (name + ".xyz"), cloud.rounded(kStep));
  for (const GoldenCase& golden : golden_cases()) {
    write_outcome(golden_folder() / (golden.name() + ".txt"),
                  plain_outcome(read_golden_cloud(golden.cloud), golden.config));
  }
}

}  // namespace lacuna
