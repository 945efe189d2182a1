// SPDX-License-Identifier: Apache-2.0
// sample.ply: what of the scan a report or a picture shows.
#include "engine/pipeline.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna::test {
namespace {

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

  fs::path detect(const Words& options) const {
    return test::detect(scan, scratch / "out", with(options, {"--every-point"}));
  }

  ScratchFolder scratch;
  std::string scan;
};

double at(const Table& table, std::size_t row, const std::string& name) {
  return table.rows[row][table.place(name)];
}

// Keys are counted by bins: any number may be the end of one.
TEST_CASE("a sample has as many points as are wanted, whatever the number, and at most all") {
  const Cloud cloud = plane(20).jittered(0.3, 1);
  const auto sampled = [&](std::int64_t wanted, std::int64_t tile_points) {
    Config config = tiled({}, tile_points);
    config.scale.every_point = true;
    config.results.sample_points = wanted;
    MemoryScan scan(cloud);
    NoProgress quiet;
    const ScratchFolder temporary;
    return detect(scan, config, temporary.path(), quiet)->sampled_points;
  };
  for (std::int64_t wanted = 0; wanted < 400; wanted += wanted < 12 ? 1 : 29) {
    INFO(wanted);
    CHECK(sampled(wanted, 100) == static_cast<std::uint64_t>(wanted));
  }
  for (const std::int64_t wanted : {399, 400, 900})
    CHECK(sampled(wanted, 0) == static_cast<std::uint64_t>(std::min<std::int64_t>(wanted, 400)));
  CHECK_FALSE(fs::exists(Runs(cloud).detect({"--sample-points", "0"}) / "sample.ply"));
}

TEST_CASE("the sample has points of the scan in ascending id, with their probabilities and colours") {
  Runs runs(plane(80).punched({40, 40}, 9).jittered(0.3, 1).shuffled(2));
  const fs::path out = runs.detect({"--points", "--points-format", "ply", "--sample-points", "1500"});
  const Table sample = read_table(out / "sample.ply"), points = read_table(out / "points.ply");
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
  const Table sample = read_table(runs.detect({"--sample-points", "2000"}) / "sample.ply");
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
}  // namespace lacuna::test
