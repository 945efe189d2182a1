// SPDX-License-Identifier: Apache-2.0
// The elementary functions against the standard library, and by each instruction set against one number
// alone.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/engine/simd/simd_test.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/maths-inl.hpp"
// clang-format on

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// Computes those of eight numbers each.
void exponentials(const double* x, double* values) {
  for (std::size_t i = 0; i < 8; i += kLanes<Doubles>)
    hn::StoreU(exponential(hn::LoadU(Doubles(), x + i)), Doubles(), values + i);
}
void angles(const double* y, double* values) {
  for (std::size_t i = 0; i < 8; i += kLanes<Doubles>)
    hn::StoreU(angle_of(hn::LoadU(Doubles(), y + i), hn::Set(Doubles(), -0.3)), Doubles(), values + i);
}
void cosines(const double* x, double* values) {
  for (std::size_t i = 0; i < 8; i += kLanes<Doubles>)
    hn::StoreU(sine_and_cosine(hn::LoadU(Doubles(), x + i)).cosine, Doubles(), values + i);
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "engine/simd/maths.hpp"
#include "engine/simd/sort.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {

HWY_EXPORT(exponentials);
HWY_EXPORT(angles);
HWY_EXPORT(cosines);

namespace {

// Numbers for which `kernel`, which computes eight at once, gives other bits than `function` alone.
template <class Kernel, class Function>
std::size_t different_bits(const std::vector<double>& x, Kernel&& kernel, Function&& function) {
  std::size_t different = 0;
  for (std::size_t first = 0; first + 8 <= x.size(); first += 8) {
    double values[8];
    kernel(&x[first], values);
    for (std::size_t i = 0; i < 8; ++i)
      different +=
          std::bit_cast<std::int64_t>(values[i]) != std::bit_cast<std::int64_t>(function(x[first + i]));
  }
  return different;
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
  by_each_instruction_set([&] {
    CHECK(different_bits(y, HWY_DYNAMIC_DISPATCH(angles), [](double v) { return angle_of(v, -0.3); }) == 0);
  });
}

TEST_CASE("exp agrees with the standard library down to where it is next to nothing") {
  std::vector<double> x = {0,      -1e-300, -0.5, -1,
                           -599.9, -700.1,  -1e6, -std::numeric_limits<double>::infinity()};
  Random random(2);
  for (int i = 0; i < 20'000; ++i) x.push_back(-random.uniform(0, i % 2 ? 30 : 600));
  double worst = 0;
  for (const double number : x) {
    const double value = exponential(number);
    if (number >= -600) worst = std::max(worst, std::abs(value / std::exp(number) - 1));
    if (number < -700) CHECK(value == 0);
  }
  CHECK(worst <= 1e-14);
  by_each_instruction_set([&] {
    CHECK(different_bits(x, HWY_DYNAMIC_DISPATCH(exponentials), [](double v) { return exponential(v); }) ==
          0);
  });
}

TEST_CASE("the cosine agrees with the standard library up to a quarter of a turn") {
  std::vector<double> x = {0, 1e-300, 1e-9, std::numbers::pi / 3, std::numbers::pi / 2};
  Random random(3);
  for (int i = 0; i < 20'000; ++i) x.push_back(random.uniform(0, std::numbers::pi / 2));
  double worst = 0;
  for (const double number : x) worst = std::max(worst, std::abs(cosine(number) - std::cos(number)));
  CHECK(worst <= 3e-16);
  std::erase_if(x, [](double number) { return number > std::numbers::pi / 3; });
  by_each_instruction_set([&] {
    CHECK(different_bits(x, HWY_DYNAMIC_DISPATCH(cosines), [](double v) { return cosine(v); }) == 0);
  });
}

// ---- Lanes sorted at once, against the standard library

namespace {

using Batches = std::vector<Batch<double>>;

// Counts the numbers of all lanes that are not where the standard library puts them.
std::size_t misplaced(const Batches& batches) {
  Batches sorted = batches;
  sort_batches(sorted.data(), batches.size());
  std::size_t wrong = 0;
  for (std::size_t lane = 0; lane < kBatchSize; ++lane) {
    std::vector<double> expected;
    for (const Batch<double>& batch : batches) expected.push_back(batch.at[lane]);
    std::sort(expected.begin(), expected.end());
    for (std::size_t i = 0; i < batches.size(); ++i) wrong += sorted[i].at[lane] != expected[i];
  }
  return wrong;
}

}  // namespace

TEST_CASE("every instruction set that the machine has is tried, with the plainest one among them") {
  CHECK(instruction_sets().size() >= 2);
  std::vector<std::int64_t> tried;
  by_each_instruction_set([&] { tried.push_back(hwy::SupportedTargets()); });
  CHECK(tried == instruction_sets());
}

// What sorts every list of zeros and ones sorts everything (Knuth, 5.3.4, theorem Z).
TEST_CASE("few batches are sorted whatever the numbers") {
  by_each_instruction_set([] {
    std::size_t wrong = 0;
    for (std::size_t count = 1; count <= 12; ++count) {
      for (unsigned first = 0; first < 1u << count; first += kBatchSize) {
        Batches batches(count);
        for (std::size_t i = 0; i < count; ++i)
          for (unsigned lane = 0; lane < kBatchSize; ++lane) batches[i].at[lane] = (first + lane) >> i & 1;
        wrong += misplaced(batches);
      }
    }
    CHECK(wrong == 0);
  });
}

// Numbers of few kinds, so that many are equal.
TEST_CASE("many batches are sorted, in registers and beyond, and the next one is left alone") {
  by_each_instruction_set([] {
    Random random(9);
    std::size_t wrong = 0;
    for (std::size_t count = 0; count <= 4 * kBatchesInRegisters + 3; ++count) {
      Batches batches(count);
      for (Batch<double>& batch : batches)
        for (double& number : batch.at) number = double(random.whole(-20, 20));
      wrong += misplaced(batches);
      batches.push_back({{-100, -100, -100, -100, -100, -100, -100, -100}});
      sort_batches(batches.data(), count);
      wrong += batches.back().at[3] != -100;
    }
    CHECK(wrong == 0);
  });
}

}  // namespace lacuna
#endif
