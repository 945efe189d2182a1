// SPDX-License-Identifier: Apache-2.0
// How large the gaps of the sampling are, from circumradii by hand.
#include "engine/boundary/tangential/sampling_radius.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna::tangential {
namespace {

constexpr TangentialConfig kConfig{.hole_radius = 0.8};

StarRadii radii_among(const std::vector<float>& radii) {
  std::vector<LinkVertex<LocalIndex>> link;
  for (const float radius : radii) link.push_back({0, radius});
  return smallest_radii(link, kConfig);
}

}  // namespace

TEST_CASE("the sampling radius depends on the circumradii alone, not on their order or their stars") {
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    std::vector<float> radii(static_cast<std::size_t>(random.whole(1, 300)));
    for (float& radius : radii) radius = static_cast<float>(random.uniform(0, 0.8));
    const double bound = random.uniform(0.1, 1);
    const auto within = [&](std::size_t of_a_star) {
      std::vector<StarRadii> stars{radii_among({})};  // of the point, then of its neighbours
      std::vector<LocalIndex> neighbours;
      for (std::size_t i = 0; i < radii.size(); i += of_a_star) {
        neighbours.push_back(static_cast<LocalIndex>(stars.size()));
        stars.push_back(radii_among(
            {radii.begin() + long(i), radii.begin() + long(std::min(i + of_a_star, radii.size()))}));
      }
      RadiiAround around;
      around.gather(0, neighbours, [&](LocalIndex q) { return ScaledRadii{stars[q], 1.0}; });
      return around.sampling_radius(bound);
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
