#include "engine/core/vector_math.hpp"

#include "tests/support/clouds.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {

TEST_CASE("atan2 of every direction agrees with the standard library to a few units in the last place") {
  std::vector<double> x = {0, 1, 0, -1, 0, 1, -1, -1, 1, 1e-300, 1e300, 1},
                      y = {0, 0, 1, 0, -1, 1, 1, -1, -1, 1e-300, 1, 1e300};
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    x.push_back(random.uniform(-1, 1) * (i % 7 == 0 ? 1e-9 : 1));
    y.push_back(random.uniform(-1, 1) * (i % 11 == 0 ? 1e-9 : 1));
  }
  x.resize(lanes(x.size()));
  y.resize(x.size());
  std::vector<double> angles(x.size());
  atan2_each(y.data(), x.data(), x.size(), angles.data());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::abs(angles[i] - std::atan2(y[i], x[i])));
  CHECK(worst <= 1e-15);
}

TEST_CASE("exp agrees with the standard library down to where it is next to nothing") {
  std::vector<double> x = {0,      -1e-300, -0.5, -1,
                           -599.9, -700.1,  -1e6, -std::numeric_limits<double>::infinity()};
  Random random(2);
  for (int i = 0; i < 20'000; ++i) x.push_back(-random.uniform(0, i % 2 ? 30 : 600));
  x.resize(lanes(x.size()));
  std::vector<double> values(x.size());
  exp_each(x.data(), x.size(), values.data());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] >= -600) worst = std::max(worst, std::abs(values[i] / std::exp(x[i]) - 1));
    if (x[i] < -700) CHECK(values[i] == 0);
  }
  CHECK(worst <= 1e-15);
}

TEST_CASE("a rank is the number of smaller values") {
  std::vector<double> values = {3, 1, 2, 2, -5, 9, 1, 7, 8, 2};
  const std::size_t count = values.size();
  values.resize(lanes(count), -100);  // beyond the count: to be passed over
  std::vector<std::uint32_t> ranks(values.size());
  count_smaller(values.data(), count, ranks.data());
  ranks.resize(count);
  CHECK(ranks == std::vector<std::uint32_t>{6, 1, 3, 3, 0, 9, 1, 7, 8, 3});
}

}  // namespace lacuna
