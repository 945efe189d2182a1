// SPDX-License-Identifier: Apache-2.0
#include "io/read/scan/scan_files.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/drawn_files.hpp"

namespace lacuna::test {
namespace {

using Positions = std::vector<Eigen::Vector3d>;

double rounded(double value, int digits) {
  return std::round(value * std::pow(10, digits)) / std::pow(10, digits);
}

// Rows of jittered positions with heights, as surveys have them.
Positions survey(const Eigen::Vector2d& corner, double spacing,
                 const std::function<double(double x, double y)>& height) {
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> jitter(-0.3 * spacing, 0.3 * spacing);
  Positions positions;
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 60; ++column) {
      const double x = column * spacing + jitter(draw), y = row * spacing + jitter(draw);
      positions.emplace_back(rounded(corner.x() + x, 7), rounded(corner.y() + y, 7), height(x, y));
    }
  }
  return positions;
}

// A depth of 24 to 26, smooth, in steps of a hundredth.
double shelf(double x, double y) {
  return rounded(-25 + std::sin(20 * x) * std::cos(10 * y), 2);
}

Positions swapped(Positions positions) {
  for (Eigen::Vector3d& position : positions) std::swap(position.x(), position.y());
  return positions;
}

}  // namespace

TEST_CASE("degrees of one survey with heights in metres are known by their values") {
  const auto rough = [](double x, double y) {
    return -2600 + 50 * std::sin(5e3 * x) + 20 * std::sin(7e3 * y);
  };
  const auto hills = [](double x, double y) { return 500 + 2 * std::sin(3e4 * x) + std::cos(2e4 * y); };
  for (const Positions& degrees : {survey({187, -18}, 0.003, rough), survey({11.5, 48.1}, 1e-5, hills),
                                   survey({-0.1, 51.5}, 1e-5, hills), survey({4.1, 52.6}, 0.002, shelf)}) {
    CHECK(look_like_degrees(degrees));
    CHECK(look_like_degrees(swapped(degrees)));
  }
}

TEST_CASE("degrees are known in files without a system and a unit") {
  const ScratchFolder folder;
  const std::string rows = Cloud{survey({4.1, 52.6}, 0.002, shelf), {}}.text();
  for (const std::string& file :
       {folder.write("a.xyz", rows), folder.write("a.ply", ascii_ply(rows, kXyz))}) {
    INFO(file);
    const ScanFiles scan({file}, {});
    CHECK(scan.files()[0].may_be_degrees);
    CHECK_FALSE(scan.files()[0].is_geographic);  // no more than a guess
  }
}

TEST_CASE("scans in lengths do not look like degrees, in any order of their points") {
  const auto ground = [](double x, double y) { return rounded(3 * std::sin(x / 2) + std::cos(y), 3); };
  const auto steep = [](double x, double) { return 60 * x; };
  std::vector<Positions> all = {survey({0, 0}, 0.1, ground), survey({30, 40}, 0.04, ground),
                                survey({0, 0}, 0.1, steep), survey({30, 40}, 0.01, steep)};
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.002);
  Positions wall, pole, sphere, stairs, cliff, frame;
  for (int i = 0; i < 4096; ++i) {
    wall.emplace_back(5 + noise(draw), i / 200 * 0.02, share(draw) * 4);
    const double turn = 2 * std::numbers::pi * share(draw), z = 2 * share(draw) - 1, r = std::sqrt(1 - z * z);
    pole.emplace_back(rounded(30 + 0.05 * std::cos(turn), 3), rounded(40 + 0.05 * std::sin(turn), 3), 10 * z);
    sphere.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    const double x = 5 * share(draw);
    stairs.emplace_back(x, share(draw), rounded(x, 0));
    cliff.emplace_back(40 * share(draw), 3 * share(draw), 45 * share(draw));
    const double depth = rounded(2 + share(draw), 2);  // of a camera, in whole centimetres
    frame.emplace_back(depth * (share(draw) - 0.5), depth * (share(draw) - 0.5), depth);
  }
  for (const Positions& positions : {wall, pole, sphere, stairs, cliff, frame}) all.push_back(positions);
  for (Positions& lengths : all) {
    CHECK_FALSE(look_like_degrees(lengths));
    CHECK_FALSE(look_like_degrees(swapped(lengths)));
    std::shuffle(lengths.begin(), lengths.end(), draw);
    CHECK_FALSE(look_like_degrees(lengths));
  }
}

}  // namespace lacuna::test
