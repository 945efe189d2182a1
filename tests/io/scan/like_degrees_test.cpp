// SPDX-License-Identifier: Apache-2.0
#include "io/scan/like_degrees.hpp"

#include "io/scan/file_scan.hpp"
#include "tests/io/las/las_file.hpp"
#include "tests/support/drawn_files.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>

#include <catch2/catch.hpp>

namespace lacuna::test {
using namespace io;

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

std::string text(const Positions& positions) {
  std::ostringstream text;
  text.precision(12);
  for (const Eigen::Vector3d& p : positions) text << p.x() << " " << p.y() << " " << p.z() << "\n";
  return text.str();
}

std::string ply(const Positions& positions, const std::string& type) {
  return ascii_ply(text(positions), type == "float" ? kXyz : kWideXyz);
}

std::string las(const Positions& positions) {
  LasFile file;
  file.scale = {1e-7, 1e-7, 0.01};
  file.offset = {0, 0, 0};
  for (const Eigen::Vector3d& p : positions)
    file.points.push_back(las_point(20, static_cast<int>(std::lround(p.x() * 1e7)),
                                    static_cast<int>(std::lround(p.y() * 1e7)),
                                    static_cast<int>(std::lround(p.z() * 100))));
  return file.bytes();
}

}  // namespace

TEST_CASE("degrees with heights in metres are known by their values") {
  const auto rough = [](double x, double y) {
    return -2600 + 50 * std::sin(5e3 * x) + 20 * std::sin(7e3 * y);
  };
  const auto hills = [](double x, double y) { return 500 + 2 * std::sin(3e4 * x) + std::cos(2e4 * y); };
  const auto smooth = [](double x, double y) { return -25 + 4 * std::sin(20 * x) * std::cos(10 * y); };
  const auto earth = [](double x, double y) { return 3000 * std::sin(0.05 * x) * std::cos(0.08 * y); };
  for (const Positions& degrees : {survey({187, -18}, 0.003, rough), survey({11.5, 48.1}, 1e-5, hills),
                                   survey({4.1, 52.6}, 0.002, shelf), survey({4.1, 52.6}, 0.002, smooth),
                                   survey({200, -60}, 1, earth)}) {
    CHECK(look_like_degrees(degrees));
    CHECK(look_like_degrees(swapped(degrees)));
  }
  Positions row;  // the first of a grid
  for (int i = 0; i < 4096; ++i) row.emplace_back(i / 60., -89.5, earth(i / 6., 0) - 100 * std::sin(i / 60.));
  CHECK(look_like_degrees(row));
}

TEST_CASE("degrees are known in every format without a system") {
  const ScratchFolder folder;
  const Positions positions = survey({4.1, 52.6}, 0.002, shelf);
  for (const std::string& file :
       {folder.write("a.xyz", text(positions)), folder.write("d.ply", ply(positions, "double")),
        folder.write("f.ply", ply(positions, "float")), folder.write("a.las", las(positions))}) {
    INFO(file);
    CHECK(FileScan({file}, {}).files()[0].is_geographic);
  }
}

TEST_CASE("small scans in lengths are not taken for degrees") {
  const auto ground = [](double x, double y) { return rounded(3 * std::sin(x / 2) + std::cos(y), 3); };
  CHECK_FALSE(look_like_degrees(survey({0, 0}, 0.1, ground)));
  CHECK_FALSE(look_like_degrees(survey({30, 40}, 0.5, ground)));
  CHECK_FALSE(
      look_like_degrees(survey({0, 0}, 0.1, [](double x, double) { return 60 * x; })));  // nearly upright
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise(0, 0.002);
  Positions wall, exact, turned, pole, sphere, stairs;
  for (int i = 0; i < 4096; ++i) {
    wall.emplace_back(5 + noise(draw), i / 1000 * 0.01, i % 1000 * 0.01);
    exact.emplace_back(5, i / 1000 * 0.01, i % 1000 * 0.01);
    turned.emplace_back(i / 64, -1e-15 * (i % 64), i % 64);  // rounded when it was turned upright
    const double turn = 2 * std::numbers::pi * share(draw), z = 2 * share(draw) - 1, r = std::sqrt(1 - z * z);
    pole.emplace_back(0.1 * std::cos(turn), 0.1 * std::sin(turn), 10 * z);
    sphere.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    const double x = 5 * share(draw);
    stairs.emplace_back(x, share(draw), rounded(x, 0));
  }
  for (const Positions& lengths : {wall, exact, turned, pole, sphere, stairs}) {
    CHECK_FALSE(look_like_degrees(lengths));
    CHECK_FALSE(look_like_degrees(swapped(lengths)));
  }
}

}  // namespace lacuna::test
