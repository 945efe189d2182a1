// SPDX-License-Identifier: Apache-2.0
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"

#include <map>

namespace lacuna {
namespace {

std::vector<double> numbers_of(const LoopMeasures& m, const std::vector<ReportedLoop>& loops) {
  const LoopEvidence& e = m.track.evidence;
  std::vector<double> numbers = {m.kind == LoopKind::kHole ? 1.0 : 0.0,
                                 double(m.points),
                                 m.perimeter,
                                 m.area,
                                 m.own_area,
                                 m.diameter,
                                 m.planarity,
                                 m.mean_probability,
                                 double(m.tiles),
                                 m.track.confidence,
                                 m.track.first_scale,
                                 m.track.last_scale,
                                 e.clearness,
                                 e.surface,
                                 e.spacing,
                                 e.sampling_gap,
                                 e.width,
                                 e.compactness,
                                 e.prominence,
                                 e.persistence};
  const Eigen::Vector3d parent =
      m.parent < 0 ? Eigen::Vector3d::Zero() : loops[static_cast<std::size_t>(m.parent)].measures.centroid;
  for (const Eigen::Vector3d& v : {m.centroid, m.normal, parent})
    numbers.insert(numbers.end(), v.begin(), v.end());
  return numbers;
}

// The numbers of each loop, by the places of its points.
using Numbers = std::map<std::vector<std::array<double, 3>>, std::vector<double>>;

Numbers loops_in(const Cloud& cloud) {
  Config config;
  config.selection.min_confidence = 0;
  const Detected detected = run_engine(cloud, tiled(config, 500));
  Numbers loops;
  for (const auto& [measures, points] : detected.loops) {
    std::vector<std::array<double, 3>> places;
    for (const LoopPoint& p : points) places.push_back({p.x, p.y, p.z});
    std::ranges::sort(places);
    loops[places] = numbers_of(measures, detected.loops);
  }
  return loops;
}

TEST_CASE("the order of the points changes neither loops nor any number of one") {
  const Cloud island = plane(8).translated({28.5, 27.5, 0});
  const Cloud holed = plane(50).punched({14, 16}, 5).punched({32, 31}, 10).joined(island);
  const Cloud cloud = holed.jittered(0.3, 1).noisy(0.05, 2).rotated({1, 2, 3}, 40);
  const auto loops = loops_in(cloud);
  CHECK(loops.size() >= 4);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto shuffled = loops_in(cloud.shuffled(seed));
    CHECK(shuffled.size() == loops.size());
    for (const auto& [places, numbers] : loops) {
      REQUIRE(shuffled.contains(places));
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        INFO("shuffled by " << seed << ", number " << i);
        CHECK(shuffled.at(places)[i] == Approx(numbers[i]).epsilon(1e-6).margin(1e-9));
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
