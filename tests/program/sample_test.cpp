// SPDX-License-Identifier: Apache-2.0
// sample.ply: what of the scan a report or a picture shows.
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
using namespace io;

namespace {

namespace fs = std::filesystem;

std::string text_of(const Cloud& cloud) {
  std::ostringstream text;
  text.precision(17);
  text << "x y z red green blue\n";
  for (std::size_t i = 0; i < cloud.size(); ++i)
    text << cloud.positions[i].transpose() << " " << i % 256 << " " << i / 256 % 256 << " 7\n";
  return text.str();
}

struct Runs {
  explicit Runs(const Cloud& cloud) : scan(scratch.write("scan.txt", text_of(cloud))) {}

  fs::path detect(const test::Words& options) const {
    return test::detect(scan, scratch / "out", test::with(options, {"--every-point"}));
  }
  std::size_t sampled(const std::string& wanted, const test::Words& options = {}) const {
    const fs::path out = detect(test::with({"--sample-points", wanted}, options));
    return test::read_table(out / "sample.ply").rows.size();
  }

  test::ScratchFolder scratch;
  std::string scan;
};

double at(const test::Table& table, std::size_t row, const std::string& name) {
  return table.rows[row][table.place(name)];
}

// Keys are counted by bins: any number may be the end of one.
TEST_CASE("a sample has as many points as are wanted, whatever the number, and at most all") {
  const Runs runs(plane(20).jittered(0.3, 1));
  for (int wanted = 1; wanted < 400; wanted += wanted < 12 ? 1 : 29) {
    INFO(wanted);
    CHECK(runs.sampled(std::to_string(wanted), {"--tile-points", "100"}) == static_cast<std::size_t>(wanted));
  }
  CHECK(runs.sampled("399") == 399);
  CHECK(runs.sampled("400") == 400);
  CHECK(runs.sampled("900") == 400);
  CHECK_FALSE(fs::exists(runs.detect({"--sample-points", "0"}) / "sample.ply"));
}

TEST_CASE("the sample has points of the scan in ascending id, with their probabilities and colours") {
  Runs runs(plane(80).punched({40, 40}, 9).jittered(0.3, 1).shuffled(2));
  const fs::path out = runs.detect({"--points", "--points-format", "ply", "--sample-points", "1500"});
  const test::Table sample = test::read_table(out / "sample.ply"),
                    points = test::read_table(out / "points.ply");
  REQUIRE(sample.rows.size() == 1500);
  double last = -1;
  for (std::size_t i = 0; i < sample.rows.size(); ++i) {
    const double id = at(sample, i, "scalar_id");
    CHECK(id > last);
    last = id;
    const auto row = static_cast<std::size_t>(id);
    for (const char* const name : {"x", "y", "z", "scalar_probability", "red", "green", "blue"}) {
      INFO(name);
      CHECK(at(sample, i, name) == at(points, row, name));
    }
    CHECK(std::abs(at(sample, i, "nz")) == Approx(1).margin(1e-6));
  }
}

TEST_CASE("the sample is spread by area, however dense the scan is, and denser near boundaries") {
  // The left half is four times as dense as the right one.
  Runs runs(density_step(160).jittered(0.2, 1));
  const test::Table sample = test::read_table(runs.detect({"--sample-points", "2000"}) / "sample.ply");
  std::map<std::string, double> counts;
  for (std::size_t i = 0; i < sample.rows.size(); ++i) {
    const double x = at(sample, i, "x"), y = at(sample, i, "y");
    const bool is_inside = y > 20 && y < 140;
    if (is_inside && x > 20 && x < 70) ++counts["left"];
    if (is_inside && x > 90 && x < 140) ++counts["right"];
    if (is_inside && x < 2) ++counts["edge"];
  }
  CHECK(counts["left"] == Approx(counts["right"]).epsilon(0.25));
  CHECK(counts["edge"] / 2 > 1.8 * counts["left"] / 50);
}

}  // namespace
}  // namespace lacuna
