// SPDX-License-Identifier: Apache-2.0
#include "tests/support/golden.hpp"

#include "engine/store/digest.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

namespace lacuna {
namespace {

constexpr double kStep = 1. / 4096;  // of coordinates, so that each machine draws the same ones

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

}  // namespace

std::vector<GoldenCase> golden_cases() {
  std::vector<GoldenCase> cases;
  for (const auto& [name, drawn] : draw_clouds()) {
    const Cloud cloud = drawn.rounded(kStep);
    const Config other = other_setting(name);
    cases.push_back({name + ".default", cloud, {}});
    cases.push_back({name + ".other", cloud, other});
    cases.push_back({name + ".paper", cloud, with_paper_loops({})});
    cases.push_back({name + ".paper-other", cloud, with_paper_loops(other)});
  }
  return cases;
}

std::string golden_lines(const GoldenCase& golden, GoldenOutcome outcome) {
  std::ostringstream probabilities, coherent, boundary;
  for (std::size_t i = 0; i < outcome.points.size(); ++i) {
    const GoldenOutcome::Point& p = outcome.points[i];
    probabilities << std::lround(p.probability * 0x1p24) << '\n';
    if (p.coherent) coherent << i << '\n';
    if (p.boundary) boundary << i << '\n';
  }
  std::ostringstream lines;
  const auto add_digest = [&](const char* kind, const std::string& of) {
    lines << golden.name << ' ' << kind << ' ' << std::hex << digest_of(of)[0] << std::dec << '\n';
  };
  add_digest("places", golden.cloud.text());
  add_digest("probabilities", probabilities.str());
  add_digest("coherent", coherent.str());
  add_digest("boundary", boundary.str());
  std::ranges::sort(outcome.loops, {}, &GoldenOutcome::Loop::points);
  lines << std::fixed << std::setprecision(3);
  for (const GoldenOutcome::Loop& loop : outcome.loops) {
    lines << golden.name << " loop of confidence " << loop.confidence << ':';
    for (const PointId id : loop.points) lines << ' ' << value(id);
    lines << '\n';
  }
  return lines.str();
}

}  // namespace lacuna
