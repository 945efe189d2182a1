// Stars along the border of a tile: active points found in what other tiles have told, and the wedges left.
#include "engine/boundary/tangential/open_stars.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr Tile kTile{.first_row = Row{64}, .raw = 8, .points = 8};
constexpr Row kForeign{200};

Row owned(LocalIndex p) {
  return kTile.row(p);
}

// The stars of a tile, its points' state, and what is found of them.
struct Border {
  StoredStars stars;
  RowSet active{256}, unmeasured{256};
  std::vector<RemoteTriangle> remote_triangles;

  // `rooms` of the triangles that begin at each corner.
  void add(LocalIndex p, const std::vector<Row>& corners, const std::vector<float>& rooms) {
    stars.add(PointId{p}, p);
    for (std::size_t i = 0; i < corners.size(); ++i)
      stars.add_corner(
          {corners[i], rooms[i], rooms[i] > 0 ? Consistency::kInconsistent : Consistency::kUndecided});
  }

  OpenStars open() { return {kTile, active, unmeasured, stars, remote_triangles}; }
  std::vector<Row> found() {
    std::vector<Row> found;
    open().find_active_points([&](Row row) { found.push_back(row); });
    std::sort(found.begin(), found.end());
    return found;
  }
};

}  // namespace

TEST_CASE("refused triangles make corners active, from star to star, here and in other tiles") {
  Border border;
  // 1 has no triangle with 0 and 2, so it refuses that of 0; the ball between 3 and the foreign point is too
  // large for a triangle of 2. The star of 5 is not reached.
  border.add(0, {owned(1), owned(2), owned(4)}, {0, 0, 0});
  border.add(1, {owned(4), owned(3), owned(6)}, {0, 0, 0});
  border.add(2, {owned(3), kForeign, owned(0)}, {2, 0, 0});
  border.add(5, {owned(6), owned(7), kForeign}, {2, 2, 2});
  border.active.insert(owned(0));
  border.active.insert(owned(1));
  // 4, which has no star, is a corner beside 1.
  const std::vector<Row> found = border.found();
  CHECK(std::count(found.begin(), found.end(), owned(2)) == 1);
  CHECK(std::count(found.begin(), found.end(), owned(3)) == 1);
  CHECK(std::count(found.begin(), found.end(), kForeign) == 1);
  CHECK_FALSE(border.active.contains(owned(5)));
  CHECK_FALSE(border.active.contains(owned(7)));
  CHECK(border.found().empty());
}

TEST_CASE("a point that is not measured yet is not asked") {
  Border border;
  border.add(0, {owned(1), owned(2), owned(3)}, {0, 0, 0});
  border.active.insert(owned(0));
  border.active.insert(owned(1));
  border.unmeasured.insert(owned(1));
  CHECK(border.found().empty());
  border.unmeasured.erase(owned(1));  // it has no star: it refuses both triangles
  CHECK(border.found() == std::vector{owned(2), owned(3)});
}

TEST_CASE("a active point of another tile agrees to the triangles that it has told of, and to no other") {
  Border border;
  border.add(0, {kForeign, owned(1), owned(2)}, {0, 0, 0});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  SECTION("both told") {
    border.remote_triangles = {{0, 0, kForeign, owned(1)}, {0, 0, kForeign, owned(2)}};
    CHECK(border.found().empty());
    CHECK(border.open().wedges().empty());
  }
  SECTION("one told") {
    border.add(1, {owned(2), owned(0), kForeign}, {0, 0, 3});
    border.add(2, {owned(1), owned(0), owned(7)}, {0, 2, 2.5});
    border.remote_triangles = {
        {0, 0, kForeign, owned(1)}, {1, 0, kForeign, owned(0)}, {3, 0, kForeign, owned(2)}};
    CHECK(border.found() == std::vector{owned(1), owned(2), owned(7)});
    // Triangles (0, 1, 2) and (0, 1, foreign) are agreed on.
    const std::vector<Wedge> wedges = border.open().wedges();
    REQUIRE(wedges.size() == 3);
    const Row ends[][3] = {
        {owned(0), owned(2), kForeign}, {owned(1), kForeign, owned(2)}, {owned(2), owned(0), owned(1)}};
    const float rooms[] = {0, 3, 2.5};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(wedges[i].point.row == ends[i][0]);
      CHECK(wedges[i].from == ends[i][1]);
      CHECK(wedges[i].to == ends[i][2]);
      CHECK(wedges[i].room == rooms[i]);
    }
  }
  SECTION("none told") {
    CHECK(border.found() == std::vector{owned(1), owned(2)});
    CHECK(border.open().wedges().empty());  // nothing is agreed
  }
}

TEST_CASE("a point is claimed if any foreign star has it") {
  const std::vector<RemoteTriangle> remote_triangles = {
      {2, 0, kForeign, owned(1)}, {2, 0, kForeign, owned(3)}, {5, 0, kForeign, owned(1)}};
  CHECK_FALSE(has_remote_triangle({}, 2));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 1));
  CHECK(has_remote_triangle(remote_triangles, 2));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 4));
  CHECK(has_remote_triangle(remote_triangles, 5));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 6));
}

}  // namespace lacuna
