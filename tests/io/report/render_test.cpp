// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/render.hpp"

#include "io/read/rows/columns.hpp"
#include "io/write/report/scene.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

// 21 x 21 points at a height. With a square hole around (15, 5), those from y = 10 on are probable boundary.
Scene with_sheet_at(float z, Scene scene, bool has_hole = false) {
  for (int y = 0; y <= 20; ++y) {
    for (int x = 0; x <= 20; ++x) {
      if (has_hole && std::abs(x - 15) < 3 && std::abs(y - 5) < 3) continue;
      scene.points.positions.push_back({float(x), float(y), z});
      scene.points.normals.push_back({0, 0, 1});
      scene.points.probabilities.push_back(has_hole && y >= 10 ? 1.0f : 0.0f);
    }
  }
  return scene;
}

// A sheet with the hole at z = 0, and its loop, of id 7.
Scene sheet() {
  Scene scene = with_sheet_at(0, {}, true);
  scene.edge = 20;
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

Picture draw(const Scene& scene, const View& view, PictureSize size, std::size_t band_bytes = kBandBytes,
             PictureStyle style = {}) {
  Picture picture{size.width, size.height, {}};
  const auto take = [&](std::span<const Colour> row) {
    picture.pixels.insert(picture.pixels.end(), row.begin(), row.end());
  };
  render(scene, view, size, style, take, band_bytes);
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
  for (const float z : {5.0f, 50.0f}) {
    const Scene scene = with_sheet_at(z, sheet());
    const View view = find_view(scene, "7", 300, 300);
    const Picture picture = draw(scene, view, {300, 300});
    CHECK(is_white(colour_at(picture, view, 15, 5)));
    CHECK(is_reddish(colour_at(picture, view, 15, 2)));
  }
}

TEST_CASE("what lies behind a chosen hole is pale, and the surface around it is not") {
  const Scene scene = with_sheet_at(-50, sheet());
  const View view = find_view(scene, "7", 300, 300);
  const Picture picture = draw(scene, view, {300, 300});
  const Colour behind = colour_at(picture, view, 15, 5), around = colour_at(picture, view, 10, 5);
  CHECK_FALSE(is_white(behind));
  CHECK(behind[0] > 230);
  CHECK(around[0] < 215);
  const View all = find_view(scene, "top", 300, 300);
  CHECK(colour_at(draw(scene, all, {300, 300}), all, 15, 5)[0] < 215);
}

TEST_CASE("a chosen loop is thick, and pale where the surface hides it, and others are thin and pale") {
  Scene scene = sheet();
  scene.loops.ids.push_back(8);
  scene.loops.measures.push_back(scene.loops.measures.front());
  for (const Eigen::Vector3f& corner : {Eigen::Vector3f(6, 2, 0), {9, 2, 0}, {9, 8, 0}, {6, 8, 0}})
    scene.loops.vertices.push_back(corner);
  scene.loops.first.push_back(8);
  const auto count = [](const Picture& picture, Colour colour) {
    return std::count(picture.pixels.begin(), picture.pixels.end(), colour);
  };
  constexpr Colour kHole = {230, 80, 30}, kPale = {249, 211, 199};
  const View view = find_view(scene, "7", 100, 100);
  const auto chosen = count(draw(scene, view, {100, 100}), kHole);
  CHECK(chosen > 200);  // about 90 pixels long
  CHECK(count(draw(scene, view, {100, 100}), kPale) > 20);
  const View all = find_view(scene, "top", 100, 100);
  CHECK(count(draw(scene, all, {100, 100}), kPale) == 0);

  scene = with_sheet_at(3.5f, std::move(scene));  // too near to be cut
  CHECK(find_view(scene, "7", 100, 100).before > 3.5f);
  const Picture hidden = draw(scene, view, {100, 100});
  CHECK(count(hidden, kHole) == 0);
  CHECK(count(hidden, kPale) > 200);
}

TEST_CASE("a scan has a roof where a ceiling hides all else from above, and none without it") {
  Scene scene = with_sheet_at(10, sheet());
  scene.origin = {0, 0, 100};
  REQUIRE(roof_height(scene));
  CHECK(*roof_height(scene) > 104);
  CHECK(*roof_height(scene) < 110);
  CHECK_FALSE(roof_height(sheet()));
  CHECK_FALSE(roof_height(Scene()));
  // A ceiling over a quarter of the plan is no roof.
  std::erase_if(scene.points.positions,
                [](const Eigen::Vector3f& p) { return p.z() > 5 && (p.x() > 10 || p.y() > 10); });
  CHECK_FALSE(roof_height(scene));
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

// How many pixels are nearly black.
std::ptrdiff_t count_ink(const Picture& picture) {
  return std::ranges::count_if(picture.pixels, [](Colour c) { return c[0] < 45 && c[1] < 45 && c[2] < 60; });
}

TEST_CASE("a picture has the ids of the loops that are seen, the same in bands of one row") {
  Scene scene = sheet();
  const PictureStyle style{.as_it_came = false, .has_ids = true};
  const View view = find_view(scene, "top", 500, 400);
  const Picture seven = draw(scene, view, {500, 400}, kBandBytes, style);
  CHECK(count_ink(draw(scene, view, {500, 400})) == 0);
  CHECK(count_ink(seven) == 11 * 2 * 2);  // dots of a 7
  CHECK(draw(scene, view, {500, 400}, 1, style).pixels == seven.pixels);
  scene.loops.ids = {8};
  CHECK(count_ink(draw(scene, view, {500, 400}, kBandBytes, style)) == 17 * 2 * 2);
  for (Eigen::Vector3f& vertex : scene.loops.vertices)
    vertex += Eigen::Vector3f(-10, 0, -5);  // below the sheet
  CHECK(count_ink(draw(scene, view, {500, 400}, kBandBytes, style)) == 0);
  CHECK(count_ink(draw(scene, find_view(scene, "8", 500, 400), {500, 400}, kBandBytes, style)) > 0);
}

TEST_CASE("labels keep apart, within the picture, and stand beside what is too small") {
  const auto box = [](float x, float y, float half) {
    const Eigen::Vector2f middle(x, y), to(half, half);
    return Eigen::AlignedBox2f(middle - to, middle + to);
  };
  const std::vector<Label> labels = place_labels(
      {{1, box(200, 200, 90)}, {2, box(205, 200, 90)}, {3, box(500, 300, 2)}, {4, box(0, 0, 90)}},
      {600, 400});
  REQUIRE(labels.size() == 2);
  CHECK(labels[0].number == 1);
  CHECK(labels[0].middle == Eigen::Vector2f(200, 200));
  CHECK(labels[1].number == 3);
  CHECK(labels[1].middle.x() > 510);
  CHECK(labels[1].middle.y() == 300);
}

TEST_CASE("a loop without vertices, since it runs through strays, has no view of its own") {
  Scene scene = sheet();
  scene.loops.vertices.clear();
  scene.loops.first = {0, 0};
  CHECK_THROWS_WITH(find_view(scene, "7", 100, 100), Contains("not drawn"));
  CHECK_NOTHROW(draw(scene, find_view(scene, "top", 100, 100), {100, 100}));
}

TEST_CASE("a scene without anything is a white picture") {
  const Scene scene;
  const Picture picture = draw(scene, find_view(scene, "oblique", 64, 48), {64, 48});
  CHECK(std::all_of(picture.pixels.begin(), picture.pixels.end(), is_white));
}

// Points at heights 100 to 109, and loops of three vertices: at 102, at 108, and from 104 to 106.
Scene tower() {
  Scene scene;
  scene.origin = {5e5, 5e6, 100};
  for (int z = 0; z < 10; ++z) {
    scene.points.positions.push_back({0, 0, float(z)});
    scene.points.probabilities.push_back(float(z) / 10);
    scene.points.normals.push_back({0, 0, z % 2 == 0 ? 1.0f : -1.0f});
  }
  for (const auto& [a, b, c] : {std::array{2, 2, 2}, {8, 8, 8}, {4, 5, 6}}) {
    for (const int z : {a, b, c}) scene.loops.vertices.push_back({1, 1, float(z)});
    scene.loops.first.push_back(3 * scene.loops.ids.size());
    scene.loops.ids.push_back(10 + scene.loops.ids.size());
    scene.loops.measures.push_back({{.points = 3, .diameter = double(a)}, {}});
  }
  scene.loops.first.push_back(9);
  return scene;
}

TEST_CASE("a section hides points above it, and loops that lie above it as a whole") {
  Scene scene = tower();
  hide_above(scene, 105);
  REQUIRE(scene.points.positions.size() == 6);
  CHECK(scene.points.positions.back().z() == 5);
  CHECK(scene.points.probabilities == std::vector<float>{0, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f});
  CHECK(scene.points.normals.size() == 6);
  CHECK(scene.points.colours.empty());
  CHECK(scene.loops.ids == std::vector<std::uint64_t>{10, 11, 12});
  CHECK(scene.loops.first == std::vector<std::size_t>{0, 3, 3, 6});
  CHECK(scene.loops.vertices[5].z() == 6);
}

template <class T>
std::vector<Colour> colours_of(Scalar type, const std::vector<std::vector<T>>& files) {
  const RowLayout layout = packed_layout(
      std::vector<std::pair<std::string, Scalar>>{{"red", type}, {"green", type}, {"blue", type}});
  ColourColumns colours(layout);
  for (const std::vector<T>& file : files) {
    colours.begin_file();
    for (const T value : file) {
      const std::array<T, 3> row = {value, value, value};
      const auto bytes = std::as_bytes(std::span(row));
      colours.load({.count = 1, .bytes = {bytes.begin(), bytes.end()}});
      colours.take(0);
    }
  }
  return colours.finish();
}

TEST_CASE("colours are scaled file by file, and floats that are hardly above 1 are shares") {
  const auto shorts = colours_of<std::uint16_t>(Scalar::kUint16, {{10, 200}, {51'400, 257}, {}, {7}});
  CHECK(shorts == std::vector<Colour>{{10, 10, 10}, {200, 200, 200}, {200, 200, 200}, {1, 1, 1}, {7, 7, 7}});
  const auto floats = colours_of<float>(Scalar::kFloat32, {{0.2f, 1.00001f}, {51, 255}});
  CHECK(floats == std::vector<Colour>{{51, 51, 51}, {255, 255, 255}, {51, 51, 51}, {255, 255, 255}});
}

}  // namespace
}  // namespace lacuna::io
