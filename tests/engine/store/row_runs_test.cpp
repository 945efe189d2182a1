// SPDX-License-Identifier: Apache-2.0
// Records of some rows: those rows are read and replaced, and no others.
#include "engine/store/row_runs.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"

#include <numeric>
#include <span>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {

TEST_CASE("rows near each other and far apart are read, and replaced without a change to the others") {
  const test::ScratchFolder folder;
  Column<std::uint64_t> column(folder / "column");
  std::vector<std::uint64_t> expected(5000);
  std::iota(expected.begin(), expected.end(), 100);
  column.write(0, expected);
  Random random(4);
  for (int round = 0; round < 20; ++round) {
    std::vector<Row> rows;
    std::vector<std::uint64_t> records;
    const double density = round % 2 == 0 ? 0.3 : 0.005;  // one run, and runs that are far apart
    for (std::uint64_t row = 0; row < expected.size(); ++row) {
      if (!random.chance(density)) continue;
      rows.push_back(Row{row});
      records.push_back(expected[row]);
    }
    CHECK(read_rows(column, std::span<const Row>(rows)) == records);
    for (std::size_t i = 0; i < rows.size(); ++i) expected[value(rows[i])] = records[i] = random.next();
    replace_rows(column, std::span<const Row>(rows), std::span<const std::uint64_t>(records));
    CHECK(column.read(0, expected.size()) == expected);
  }
  CHECK(read_rows(column, std::span<const Row>()).empty());
}

}  // namespace lacuna
