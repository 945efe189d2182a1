// Offsets of neighbours gathered side by side.
#include "engine/criteria/bundle.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::vector<GatherNeighbours*> available_sets() {
  std::vector<GatherNeighbours*> sets{plain::gather_neighbours};
#if defined(__x86_64__) && !defined(LACUNA_PORTABLE)
  if (__builtin_cpu_supports("x86-64-v3")) sets.push_back(v3::gather_neighbours);
  if (__builtin_cpu_supports("x86-64-v4")) sets.push_back(v4::gather_neighbours);
#endif
  return sets;
}

}  // namespace

// The last position is the last there is: nothing is read beyond it (valgrind would tell).
TEST_CASE("a row has the offsets of as many neighbours as there are points, and 0 where there are no more") {
  Random random(8);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    const auto points = std::size_t(random.whole(1, 50));
    std::vector<double> positions(3 * points);
    for (double& coordinate : positions) coordinate = random.uniform(-1, 1);
    std::vector<std::vector<LocalIndex>> neighbours(kBundle);
    BundledNeighbours of{.positions = positions.data(), .points = {}, .neighbours = {}, .counts = {}};
    std::size_t rows = 0;
    for (std::size_t i = 0; i < kBundle; ++i) {
      const auto drawn = [&] { return LocalIndex(random.whole(0, std::int64_t(points) - 1)); };
      neighbours[i].resize(std::size_t(random.whole(1, 20)));
      std::generate(neighbours[i].begin(), neighbours[i].end(), drawn);
      of.points[i] = drawn();
      of.neighbours[i] = neighbours[i].data();
      of.counts[i] = std::uint32_t(neighbours[i].size());
      rows = std::max(rows, neighbours[i].size());
    }
    for (GatherNeighbours* const gather : available_sets()) {
      std::vector<Eight> columns(4 * rows);
      Bundle bundle{.rows = rows, .x = &columns[0], .y = &columns[rows], .z = &columns[2 * rows]};
      bundle.squared_distance = &columns[3 * rows];
      gather(of, bundle);
      for (std::size_t i = 0; i < kBundle; ++i) {
        double sum = 0;
        for (std::size_t row = 0; row < rows; ++row) {
          const bool is_there = row < neighbours[i].size();
          double squared = 0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const double expected =
                is_there ? positions[3 * neighbours[i][row] + axis] - positions[3 * of.points[i] + axis] : 0;
            wrong += columns[axis * rows + row].at[i] != expected;
            squared += expected * expected;
          }
          wrong += columns[3 * rows + row].at[i] != squared;
          sum += std::sqrt(squared);
        }
        wrong += bundle.mean_distance.at[i] != sum / double(neighbours[i].size());
      }
    }
  }
  CHECK(wrong == 0);
}

}  // namespace lacuna
