// SPDX-License-Identifier: Apache-2.0
// Offsets of neighbours gathered side by side.
#include "engine/criteria/neighbour_batch.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace lacuna {
// The last position is the last there is: nothing is read beyond it (valgrind would report it).
TEST_CASE("a row has the offsets of as many neighbours as there are points, and 0 where there are no more") {
  Random random(8);
  std::size_t wrong = 0;
  for (int round = 0; round < 200; ++round) {
    const auto points = std::size_t(random.whole(1, 50));
    std::vector<double> positions(3 * points);
    for (double& coordinate : positions) coordinate = random.uniform(-1, 1);
    std::vector<std::vector<LocalIndex>> neighbours(kBatchSize);
    NeighbourLists of{.positions = positions.data(), .points = {}, .neighbours = {}, .counts = {}};
    std::size_t rows = 0;
    for (std::size_t i = 0; i < kBatchSize; ++i) {
      const auto drawn = [&] { return LocalIndex(random.whole(0, std::int64_t(points) - 1)); };
      neighbours[i].resize(std::size_t(random.whole(1, 20)));
      std::generate(neighbours[i].begin(), neighbours[i].end(), drawn);
      of.points[i] = drawn();
      of.neighbours[i] = neighbours[i].data();
      of.counts[i] = std::uint32_t(neighbours[i].size());
      rows = std::max(rows, neighbours[i].size());
    }
    by_each_instruction_set([&] {
      std::vector<Batch<double>> columns(4 * rows);
      NeighbourBatch batch{.ranks = rows, .x = &columns[0], .y = &columns[rows], .z = &columns[2 * rows]};
      batch.squared_distance = &columns[3 * rows];
      gather_neighbours(of, batch);
      for (std::size_t i = 0; i < kBatchSize; ++i) {
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
        wrong += batch.mean_distance.at[i] != sum / double(neighbours[i].size());
      }
    });
  }
  CHECK(wrong == 0);
}

}  // namespace lacuna
