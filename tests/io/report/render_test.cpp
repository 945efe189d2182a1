// SPDX-License-Identifier: Apache-2.0
#include "io/report/render.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

namespace lacuna::io {
namespace {

using Catch::Contains;

// A sheet of 21 x 21 points at z = 0 with a square hole around (15, 5), and its loop, of id 7.
Scene sheet() {
  Scene scene;
  scene.edge = 20;
  for (int y = 0; y <= 20; ++y) {
    for (int x = 0; x <= 20; ++x) {
      if (std::abs(x - 15) < 3 && std::abs(y - 5) < 3) continue;
      scene.points.positions.push_back({float(x), float(y), 0});
      scene.points.normals.push_back({0, 0, 1});
      scene.points.probabilities.push_back(y < 10 ? 0.0f : 1.0f);
    }
  }
  scene.points.spacing = 1;
  scene.loops.ids = {7};
  scene.loops.all = 1;
  scene.loops.measures = {{{.kind = LoopKind::kHole, .points = 4, .diameter = 8.5, .normal = {0, 0, 1}}, {}}};
  scene.loops.vertices = {{12, 2, 0}, {18, 2, 0}, {18, 8, 0}, {12, 8, 0}};
  scene.loops.first = {0, 4};
  return scene;
}

struct Picture {
  std::size_t width, height;
  std::vector<Colour> pixels;  // row by row from the top
};

Picture draw(const Scene& scene, const View& view, PictureSize size, std::size_t band_bytes = kBandBytes) {
  Picture picture{size.width, size.height, {}};
  const auto take = [&](std::span<const Colour> row) {
    picture.pixels.insert(picture.pixels.end(), row.begin(), row.end());
  };
  render(scene, view, size, false, take, band_bytes);
  return picture;
}

bool is_reddish(Colour c) {
  return c[0] > c[1] + 60 && c[0] > c[2] + 40;
}
bool is_greenish(Colour c) {
  return c[1] > c[0] + 40;
}
bool is_white(Colour c) {
  return c[0] > 250 && c[1] > 250 && c[2] > 250;
}

// At a place of the sheet, seen from above.
Colour colour_at(const Picture& picture, const View& view, double x, double y) {
  const double scale = double(picture.height) / (2 * view.half_height);
  const auto column = std::size_t(double(picture.width) / 2 + scale * (x - view.middle.x()));
  const auto row = std::size_t(double(picture.height) / 2 - scale * (y - view.middle.y()));
  return picture.pixels.at(row * picture.width + column);
}

TEST_CASE("a picture from above has the surface, its hole and the loop where they are") {
  const Scene scene = sheet();
  const View view = find_view(scene, "top", 400, 300);
  const Picture picture = draw(scene, view, {400, 300});
  REQUIRE(picture.pixels.size() == 400 * 300);
  CHECK(is_white(colour_at(picture, view, 15, 5)));
  CHECK_FALSE(is_white(colour_at(picture, view, 5, 5)));
  CHECK_FALSE(is_reddish(colour_at(picture, view, 5, 5)));
  CHECK(is_greenish(colour_at(picture, view, 5, 15)));  // probable boundary
  CHECK(is_reddish(colour_at(picture, view, 15, 2)));   // the loop
  CHECK(is_white(colour_at(picture, view, -4, 10)));    // next to the sheet
}

TEST_CASE("a loop is seen along its normal, with as much around it") {
  const Scene scene = sheet();
  const View view = find_view(scene, "7", 300, 300);
  CHECK(view.towards.isApprox(Eigen::Vector3f(0, 0, 1)));
  CHECK((view.middle - Eigen::Vector3f(15, 5, 0)).norm() < 1e-4f);
  CHECK(view.half_height > 6);
  CHECK(view.half_height < 12);
}

TEST_CASE("what lies before a loop at some distance does not hide it") {
  Scene scene = sheet();
  for (int y = 0; y <= 20; ++y) {
    for (int x = 0; x <= 20; ++x) {
      scene.points.positions.push_back({float(x), float(y), 50});
      scene.points.normals.push_back({0, 0, 1});
      scene.points.probabilities.push_back(0);
    }
  }
  const View view = find_view(scene, "7", 300, 300);
  CHECK(is_white(colour_at(draw(scene, view, {300, 300}), view, 15, 5)));
}

TEST_CASE("a view of another name is an error that says what is allowed") {
  CHECK_THROWS_WITH(find_view(sheet(), "below", 100, 100),
                    Contains("oblique, top, front, side or the id of a loop") && Contains("such as 7"));
  CHECK_THROWS_WITH(find_view(sheet(), "8", 100, 100), Contains("view '8'"));
}

TEST_CASE("a picture is the same in one band and in bands of one row") {
  const Scene scene = sheet();
  for (const char* const name : {"oblique", "top", "7"}) {
    const View view = find_view(scene, name, 123, 77);
    const Picture whole = draw(scene, view, {123, 77});
    REQUIRE(whole.pixels.size() == 123 * 77);
    CHECK(draw(scene, view, {123, 77}, 1).pixels == whole.pixels);
    CHECK(draw(scene, view, {123, 77}, 50'000).pixels == whole.pixels);
  }
}

TEST_CASE("a loop without vertices, since it runs through strays, has no view of its own") {
  Scene scene = sheet();
  scene.loops.vertices.clear();
  scene.loops.first = {0, 0};
  CHECK_THROWS_WITH(find_view(scene, "7", 100, 100), Contains("far from all others"));
  CHECK_NOTHROW(draw(scene, find_view(scene, "top", 100, 100), {100, 100}));
}

TEST_CASE("a scene without anything is a white picture") {
  const Scene scene;
  const Picture picture = draw(scene, find_view(scene, "oblique", 64, 48), {64, 48});
  CHECK(std::all_of(picture.pixels.begin(), picture.pixels.end(), is_white));
}

}  // namespace
}  // namespace lacuna::io
