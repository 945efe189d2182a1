// SPDX-License-Identifier: Apache-2.0
// A program with a fourth criterion. One source of the engine is compiled anew for it, with one more line in
// the table of criteria (tests/CMakeLists.txt). Everything else is the library as it is.
#include "tests/io/io_support.hpp"
#include "tests/support/run_program.hpp"

namespace lacuna {
using namespace io;

namespace {

// Two faces that join at right angles in the line x = 0.
std::string folded_sheet() {
  std::ostringstream text;
  text << "x y z\n";
  for (int x = -20; x <= 20; ++x)
    for (int y = 0; y <= 20; ++y) text << x << ' ' << y << ' ' << std::abs(x) << '\n';
  return text.str();
}

TEST_CASE("one more line in the table is one more criterion: its weight, its part of Pi and its column") {
  const ScratchFolder folder;
  const auto scan = folder.write("folded.xyz", folded_sheet());
  const auto detect = [&](const char* program, const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{program,           "detect", scan,    "--points",
                                   "--points-format", "ply",    "--out", folder / out};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_command(words);
  };
  REQUIRE(detect(LACUNA_PROGRAM, "three", {}).exit_code == 0);
  const std::string config = folder.write("four.toml", "[criteria]\nweight_curvature = 7.0\n");
  CHECK_THAT(detect(LACUNA_PROGRAM, "none", {"--config", config}).err, Contains("weight_curvature"));
  const auto four = detect(LACUNA_PROGRAM_OF_FOUR, "four", {"--config", config});
  INFO(four.err);
  REQUIRE(four.exit_code == 0);
  CHECK_THAT(test::run_command({LACUNA_PROGRAM_OF_FOUR, "detect", "--print-config"}).out,
             Contains("Share of the curvature criterion."));

  const test::Table before = test::read_table(folder.path() / "three" / "points.ply");
  const test::Table after = test::read_table(folder.path() / "four" / "points.ply");
  std::vector<std::string> names = before.names;
  names.insert(std::find(names.begin(), names.end(), "scalar_shape") + 1, "scalar_curvature");
  CHECK(after.names == names);
  for (const char* column : {"x", "scalar_angle", "scalar_halfdisc", "scalar_shape"})
    CHECK(after.column(column) == before.column(column));

  const std::vector<double> x = after.column("x"), angle = after.column("scalar_angle"),
                            halfdisc = after.column("scalar_halfdisc"), shape = after.column("scalar_shape"),
                            curvature = after.column("scalar_curvature"),
                            probability = after.column("scalar_probability");
  std::size_t wrong = 0, bent = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double combined = (angle[i] + halfdisc[i] + shape[i] + 7 * curvature[i]) / 10;
    wrong += !(std::abs(probability[i] - combined) <= 1e-6);
    wrong += std::abs(x[i]) > 5 && !(curvature[i] < 1e-6);
    bent += x[i] == 0 && curvature[i] > 0.05;
  }
  CHECK(x.size() == 861);
  CHECK(wrong == 0);
  CHECK(bent == 21);
}

}  // namespace
}  // namespace lacuna
