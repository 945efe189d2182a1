// SPDX-License-Identifier: Apache-2.0
// Lanes sorted at once, by each instruction set, against the standard library.
#include "engine/simd/sort.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace lacuna {
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
