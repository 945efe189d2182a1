// SPDX-License-Identifier: Apache-2.0
// probability.vdb, as OpenVDB's own reader sees it.
#include "tests/io/io_support.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/vdb_grids.hpp"

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

namespace fs = std::filesystem;

std::string make_surface(const test::ScratchFolder& scratch, const std::string& name) {
  const std::string scan = (scratch / name).string();
  REQUIRE(test::run_bench({"synth", "surface", scan, "--points", "12000", "--holes", "4", "--hole-radius",
                           "3", "6", "--order", "random"})
              .exit_code == 0);
  return scan;
}

TEST_CASE(
    "OpenVDB's reader finds in each voxel of probability.vdb the largest probability of points.ply there") {
  const test::ScratchFolder scratch;
  const std::string surface = make_surface(scratch, "surface.ply");
  // The scan is placed on Earth, with all digits.
  const test::Table table = test::read_table(surface);
  std::string text = "x y z\n";
  for (const auto& row : table.rows)
    text += std::to_string(row[0] + 500'000) + " " + std::to_string(row[1] + 5'400'000) + " " +
            std::to_string(row[2]) + "\n";
  for (const std::string& scan : {surface, scratch.write("earth.txt", text)}) {
    const fs::path out = scratch / "out";
    test::detect(scan, out, {"--points", "--points-format", "ply", "--vdb"});
    const auto grids = test::read_vdb_grids(out / "probability.vdb");
    REQUIRE(grids.size() == 1);
    const test::VdbGrid& grid = grids.at("boundary_probability");
    CHECK(grid.background == 0);
    CHECK(grid.metadata.at("unit") == "unit of the scan");
    CHECK(grid.metadata.at("points_left_out") == "0");
    CHECK(grid.metadata.at("class") == "fog volume");

    const test::Table points = test::read_table(out / "points.ply");
    const std::size_t column = points.place("scalar_probability");
    std::map<std::array<std::int32_t, 3>, double> expected;
    for (const auto& row : points.rows) {
      std::array<std::int32_t, 3> voxel{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        voxel[axis] = static_cast<std::int32_t>(
            std::floor((row[axis] - (grid.first_voxel[axis] - grid.voxel / 2)) / grid.voxel));
      double& value = expected[voxel];
      value = std::max(value, row[column]);
    }
    CHECK((grid.values == expected));
    CHECK(expected.size() > 2000);
  }
}

}  // namespace
}  // namespace lacuna
