// SPDX-License-Identifier: Apache-2.0
// How large the gaps of the sampling are, from circumradii by hand.
#include "engine/boundary/tangential/sampling_radius.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/draws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::tangential {
namespace {

constexpr TangentialConfig kConfig{.hole_radius = 0.8};

StarRadii radii_among(const std::vector<float>& radii) {
  std::vector<LinkVertex<LocalIndex>> link;
  for (const float radius : radii) link.push_back({0, radius});
  return smallest_radii(link, kConfig);
}

// In ascending order, without those that are left free.
std::vector<float> sorted(const StarRadii& star) {
  std::vector<float> radii(star.radii.begin(), star.radii.end());
  std::erase(radii, std::numeric_limits<float>::infinity());
  std::sort(radii.begin(), radii.end());
  return radii;
}

// The circumradii 1, 2, ..., in stars of five.
SamplingRadius counting_to(int last, double distance) {
  SamplingRadius around;
  for (int first = 1; first <= last; first += 5) {
    std::vector<float> radii;
    for (int i = first; i < first + 5 && i <= last; ++i) radii.push_back(static_cast<float>(i) / 256);
    around.add(radii_among(radii), 256 * distance);
  }
  return around;
}

}  // namespace

TEST_CASE("radii of a star are those that do not lie in a hole, the eight smallest if there are more") {
  CHECK(sorted(radii_among({0.5f, 8, 0.25f, 0.9f, 0.75f})) == std::vector{0.25f, 0.5f, 0.75f});
  CHECK(sorted(radii_among({})).empty());
  CHECK(sorted(radii_among({0.7f, 0.6f, 0.5f, 0.1f, 0.2f, 0.3f, 0.4f, 0.72f, 0.05f, 9, 0.15f})) ==
        std::vector{0.05f, 0.1f, 0.15f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f});
}

TEST_CASE(
    "nine in ten circumradii within a bound are no larger than the sampling radius, to a 64th of the bound") {
  // From 1 to 100, it is the one after the first 90, which is 91.
  for (const double scale : {1., 1e-9, 1e9}) {
    SamplingRadius around = counting_to(100, scale);
    CHECK(around.within(128 * scale) / scale == Approx(92).epsilon(1e-12));            // steps of 2
    CHECK(around.within(65 * scale) / scale == Approx(65. * 58 / 64).epsilon(1e-12));  // of 1 to 64: 58
    CHECK(around.within(0.5 * scale) == 0.5 * scale);                                  // none: the bound
  }
}

TEST_CASE("the sampling radius depends on the circumradii alone, not on their order or their stars") {
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    std::vector<float> radii(static_cast<std::size_t>(random.whole(1, 300)));
    for (float& radius : radii) radius = static_cast<float>(random.uniform(0, 0.8));
    const double bound = random.uniform(0.1, 1);
    const auto within = [&](std::size_t of_a_star) {
      SamplingRadius around;
      for (std::size_t i = 0; i < radii.size(); i += of_a_star)
        around.add(radii_among({radii.begin() + long(i),
                                radii.begin() + long(std::min(i + of_a_star, radii.size()))}),
                   1);
      return around.within(bound);
    };
    const double at_once = within(8);
    std::sort(radii.begin(), radii.end());
    CHECK(within(3) == at_once);
    std::erase_if(radii, [&](float radius) { return radius >= bound; });
    if (radii.empty()) continue;
    const double exact = radii[radii.size() * 9 / 10];
    CHECK(at_once > exact);
    CHECK(at_once <= exact + bound / 64 * (1 + 1e-9));
  }
}

}  // namespace lacuna::tangential
