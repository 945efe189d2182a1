// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/sphere_index.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

using namespace lacuna::synth;

TEST_CASE("the spheres around a place are those that trying all of them finds") {
  const Random random(7, 0);
  std::vector<Sphere> spheres;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const double radius = std::ldexp(1.0, -static_cast<int>(i % 9)) * random.uniform(4 * i, 0.5, 1);
    spheres.push_back({{random.uniform(4 * i + 1, -5, 5), random.uniform(4 * i + 2, -5, 5),
                        random.uniform(4 * i + 3, -5, 5)},
                       radius});
  }
  const SphereIndex index(spheres);
  const Random places(7, 1);
  std::size_t found = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    // Some places are centres, which the smallest spheres hold.
    const Vec3 place = i % 4 == 0 ? spheres[i].centre
                                  : Vec3{places.uniform(3 * i, -6, 6), places.uniform(3 * i + 1, -6, 6),
                                         places.uniform(3 * i + 2, -6, 6)};
    std::vector<std::uint32_t> expected, around;
    for (std::uint32_t number = 0; number < spheres.size(); ++number) {
      const Vec3 arm = place - spheres[number].centre;
      if (dot(arm, arm) <= spheres[number].radius * spheres[number].radius) expected.push_back(number);
    }
    index.for_each_around(place, [&](std::uint32_t number) { around.push_back(number); });
    std::sort(around.begin(), around.end());
    CHECK(around == expected);
    found += around.size();
  }
  CHECK(found > 1000);
}

TEST_CASE("no sphere is around a place where there are none") {
  SphereIndex({}).for_each_around({0, 0, 0}, [](std::uint32_t) { CHECK(false); });
}
