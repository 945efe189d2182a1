// The elementary functions of the lanes against the standard library, for one number and for several.
#include "engine/core/lanes.hpp"

#include "tests/support/clouds.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

// The function of each value alone, after a check that lanes give the same bits.
template <class Function>
std::vector<double> each(const std::vector<double>& values, Function&& function) {
  std::vector<double> results;
  std::size_t different = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    results.push_back(function(values[i]));
    Lanes lanes{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = values[(i + lane) % values.size()];
    different += std::bit_cast<std::int64_t>(function(lanes)[0]) != std::bit_cast<std::int64_t>(results[i]);
  }
  CHECK(different == 0);
  return results;
}

}  // namespace

TEST_CASE("the angle of every direction agrees with the standard library to a few units in the last place") {
  std::vector<double> x = {0, 1, 0, -1, 0, 1, -1, -1, 1, 1e-300, 1e300, 1},
                      y = {0, 0, 1, 0, -1, 1, 1, -1, -1, 1e-300, 1, 1e300};
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    x.push_back(random.uniform(-1, 1) * (i % 7 == 0 ? 1e-9 : 1));
    y.push_back(random.uniform(-1, 1) * (i % 11 == 0 ? 1e-9 : 1));
  }
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::abs(angle_of(y[i], x[i]) - std::atan2(y[i], x[i])));
  CHECK(worst <= 1e-15);
  each(y, [](auto value) { return angle_of(value, decltype(value){} - 0.3); });
}

TEST_CASE("exp agrees with the standard library down to where it is next to nothing") {
  std::vector<double> x = {0,      -1e-300, -0.5, -1,
                           -599.9, -700.1,  -1e6, -std::numeric_limits<double>::infinity()};
  Random random(2);
  for (int i = 0; i < 20'000; ++i) x.push_back(-random.uniform(0, i % 2 ? 30 : 600));
  const std::vector<double> values = each(x, [](auto value) { return exponential(value); });
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] >= -600) worst = std::max(worst, std::abs(values[i] / std::exp(x[i]) - 1));
    if (x[i] < -700) CHECK(values[i] == 0);
  }
  CHECK(worst <= 1e-14);
}

TEST_CASE("sine and cosine agree with the standard library up to a third of half a turn") {
  std::vector<double> x = {0, 1e-300, 1e-9, std::numbers::pi / 3};
  Random random(3);
  for (int i = 0; i < 20'000; ++i) x.push_back(random.uniform(0, std::numbers::pi / 3));
  const auto part = [](bool sine) {
    return [sine](auto value) {
      decltype(value) s, c;
      sine_and_cosine(value, s, c);
      return sine ? s : c;
    };
  };
  const std::vector<double> sines = each(x, part(true)), cosines = each(x, part(false));
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    worst = std::max(worst, std::abs(sines[i] - std::sin(x[i])));
    worst = std::max(worst, std::abs(cosines[i] - std::cos(x[i])));
  }
  CHECK(worst <= 3e-16);
}

}  // namespace lacuna
