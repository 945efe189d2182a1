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

TEST_CASE("a loop is seen along its normal, and fills 0.6 of the picture") {
  const Scene scene = sheet();
  const View view = find_view(scene, "7", 300, 300);
  CHECK(view.towards.isApprox(Eigen::Vector3f(0, 0, 1)));
  CHECK((view.middle - Eigen::Vector3f(15, 5, 0)).norm() < 1e-4f);
  CHECK(view.half_height == Approx(3 / 0.6f));
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
  for (const Eigen::Vector3f& corner :
       {Eigen::Vector3f(10.5f, 2, 0), {11.5f, 2, 0}, {11.5f, 8, 0}, {10.5f, 8, 0}})
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

TEST_CASE("a scan has a cut below each ceiling that hides all else from above, and none without ceilings") {
  Scene scene = with_sheet_at(10, sheet());
  scene.origin = {0, 0, 100};
  const std::vector<double> one = ceiling_cuts(scene);
  REQUIRE(one.size() == 1);
  CHECK(one.front() > 107);
  CHECK(one.front() < 110);
  CHECK(ceiling_cuts(sheet()).empty());
  CHECK(ceiling_cuts(Scene()).empty());
  // Another storey, whose floor is near the first ceiling.
  const std::vector<double> two = ceiling_cuts(with_sheet_at(21, with_sheet_at(11, scene)));
  REQUIRE(two.size() == 2);
  CHECK(two.front() > 117);
  CHECK(std::abs(two.back() - one.front()) < 1);
  // Crowns of trees are not level, and a ceiling over a quarter of the plan hides little.
  Scene crowns = scene;
  std::ranges::fill(crowns.points.normals, Eigen::Vector3f(0.8f, 0, 0.6f));
  CHECK(ceiling_cuts(crowns).empty());
  std::erase_if(scene.points.positions,
                [](const Eigen::Vector3f& p) { return p.z() > 5 && (p.x() > 10 || p.y() > 10); });
  CHECK(ceiling_cuts(scene).empty());
}

TEST_CASE("a picture is as large as 98 in 100 points and a sure hole need, not as far pieces do") {
  Scene scene = sheet();
  const float all = find_view(scene, "top", 300, 300).half_height;
  CHECK(all == Approx(1.05f * 10));  // the edge of the sheet is not cut
  for (const float x : {300.0f, 310.0f, 320.0f}) scene.points.positions.push_back({x, x, 0});
  CHECK(find_view(scene, "top", 300, 300).half_height < 1.3f * all);
  scene.loops.vertices[2] = {60, 8, 0};
  CHECK(find_view(scene, "top", 300, 300).half_height > 2.5f * all);
}

TEST_CASE("loops near the spacing are folded where they are many, and drawn where one is chosen") {
  Scene scene = sheet();
  const auto count = [&](const char* name) {
    const Picture picture = draw(scene, find_view(scene, name, 200, 200), {200, 200});
    return std::ranges::count_if(picture.pixels, is_reddish);
  };
  scene.loops.measures.front().track.evidence.width = 2.9;
  const auto drawn = count("top");
  CHECK(drawn > 0);
  for (std::uint64_t id = 100; scene.loops.ids.size() < 20; ++id) {
    scene.loops.ids.push_back(id);
    scene.loops.measures.push_back(scene.loops.measures.front());
    scene.loops.first.push_back(scene.loops.vertices.size());
  }
  CHECK(count("top") == 0);
  CHECK(count("7") > 0);
  scene.loops.measures.front().track.evidence.width = 3;  // the others are 19
  CHECK(count("top") == drawn);
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

TEST_CASE("nothing above the highest height is drawn, and a loop that lies there as a whole has no view") {
  Scene scene = with_sheet_at(5, sheet());
  const View all = find_view(scene, "top", 200, 200);
  CHECK_FALSE(is_white(colour_at(draw(scene, all, {200, 200}), all, 15, 5)));
  scene.highest = 4;
  const View below = find_view(scene, "top", 200, 200);
  const Picture picture = draw(scene, below, {200, 200});
  CHECK(is_white(colour_at(picture, below, 15, 5)));
  CHECK_FALSE(is_white(colour_at(picture, below, 5, 5)));
  CHECK(is_reddish(colour_at(picture, below, 15, 2)));
  scene.highest = -1;
  const Picture none = draw(scene, find_view(scene, "top", 200, 200), {200, 200});
  CHECK(std::all_of(none.pixels.begin(), none.pixels.end(), is_white));
  CHECK_THROWS_WITH(find_view(scene, "7", 200, 200), Contains("above --hide-above"));
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
