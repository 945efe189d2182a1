// SPDX-License-Identifier: Apache-2.0
// Poses and filters, from the command line to the report.
#include "tests/support/clouds.hpp"
#include "tests/support/json.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

using nlohmann::json;

std::string rows_of(const Cloud& cloud, int classification) {
  std::string rows = cloud.text();
  for (std::size_t at = 0; (at = rows.find('\n', at)) != rows.npos; at += 3)
    rows.insert(at, " " + std::to_string(classification));
  return rows;
}

TEST_CASE("scans in their own coordinates with poses, and filters, give the loops of the chosen points") {
  const ScratchFolder scratch;
  const Cloud left = plane(30).punched({14, 14}, 4).translated({0, 0, 1});
  const Cloud right = plane(30).punched({20, 9}, 3).translated({30, 0, 1});
  const std::string header = "x y z Classification\n";
  const auto whole = scratch.write("whole.csv", header + rows_of(left, 2) + rows_of(right, 2));
  const json expected = read_json(detect(whole, scratch / "whole") / "holes.json");
  REQUIRE(expected["counts"]["holes"] == 2);

  // The right part has its origin elsewhere; points of class 7 fill its hole, points at 0 0 0 have no return.
  scratch.write("left.csv", header + rows_of(left, 2));
  scratch.write("right.csv", header + rows_of(right.translated({-512, 1024, 0}), 2) +
                                 rows_of(plane(8).translated({30 - 512 + 17, 1024 + 6, 1}), 7) +
                                 "0 0 0 2\n0 0 0 2\n");
  const auto list = scratch.write("list.txt", "left.csv\nright.csv pose=512 -1024 0 0 0 0 1\n");
  const json found =
      read_json(detect("@" + list, scratch / "posed",
                       {"--where", "Classification == 2 or z > 100", "--drop-origin", "--keep-noise"}) /
                "holes.json");
  CHECK(found["loops"] == expected["loops"]);
  CHECK(found["counts"]["filtered_out"]["where"] == 64);
  CHECK(found["counts"]["filtered_out"]["origin"] == 2);
  CHECK(found["counts"]["dropped"] == 0);
  CHECK(found["inputs"][1]["pose"] == json({1, 0, 0, 512, 0, 1, 0, -1024, 0, 0, 1, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace lacuna::test
