// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/permutation.hpp"
#include "bench/synth/random.hpp"
#include "bench/synth/trig.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using namespace lacuna::synth;

TEST_CASE("sine and cosine are within 4e-16 of the true ones") {
  double worst = 0;
  for (int i = -100'000; i <= 300'000; ++i) {
    const double turns = i * 1e-5;
    const long double angle = 2 * 3.14159265358979323846264338327950288L * static_cast<long double>(turns);
    worst = std::fmax(worst, static_cast<double>(std::fabs(sin_cos(turns).sin - std::sin(angle))));
    worst = std::fmax(worst, static_cast<double>(std::fabs(sin_cos(turns).cos - std::cos(angle))));
  }
  CHECK(worst < 4e-16);
}

TEST_CASE("quarter turns are exact") {
  CHECK(sin_cos(0).cos == 1);
  CHECK(sin_cos(0.25).sin == 1);
  CHECK(sin_cos(0.5).cos == -1);
  CHECK(sin_cos(-0.25).sin == -1);
}

TEST_CASE("a permutation visits every index once, for every size") {
  for (std::uint64_t size = 1; size <= 300; ++size) {
    const Permutation order(size, size);
    std::vector<int> met(size);
    for (std::uint64_t index = 0; index < size; ++index) ++met.at(order(index));
    CHECK(met == std::vector<int>(size, 1));
  }
}
