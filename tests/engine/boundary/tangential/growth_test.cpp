// Stars along the border of a tile: active points found with what other tiles sent, and the wedges left.
#include "engine/boundary/tangential/growth.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr Row kForeign{200};

// Two tiles; the first one grows.
Tiling two_tiles() {
  Tiling tiling;
  tiling.tiles = {{.first_row = Row{64}, .raw = 64, .points = 8},
                  {.first_row = Row{128}, .raw = 128, .points = 128}};
  return tiling;
}

Row owned(LocalIndex p) {
  return Row{64 + p};
}

// The open stars of a tile, and what is found of them.
struct Border {
  Tiling tiling = two_tiles();
  OpenStars stars;
  RowSet active{256};
  std::vector<std::uint8_t> is_measured{1, 1};
  std::vector<RemoteTriangle> remote_triangles;

  // `excesses` of the triangles that begin at each link vertex.
  void add(LocalIndex p, const std::vector<Row>& link, const std::vector<float>& excesses) {
    stars.add(PointId{p}, p, {.largest = 1, .unit = 1});
    for (std::size_t i = 0; i < link.size(); ++i)
      stars.add_vertex(
          {link[i], 1 + excesses[i], excesses[i] > 0 ? Consistency::kInconsistent : Consistency::kUndecided});
  }

  Growth growth() { return {tiling, 0, is_measured, active, stars, remote_triangles}; }
  std::vector<Row> found() {
    std::vector<Row> found;
    growth().find_active_points([&](Row row) { found.push_back(row); });
    std::sort(found.begin(), found.end());
    return found;
  }
};

}  // namespace

TEST_CASE("vertices of inconsistent triangles become active, from star to star, here and in other tiles") {
  Border border;
  // The star of 1 lacks the triangle (0, 1, 2) of 0. The ball between 3 and the foreign point is too large
  // for a triangle of 2. The star of 5 is not reached.
  border.add(0, {owned(1), owned(2), owned(4)}, {0, 0, 0});
  border.add(1, {owned(4), owned(3), owned(6)}, {0, 0, 0});
  border.add(2, {owned(3), kForeign, owned(0)}, {2, 0, 0});
  border.add(5, {owned(6), owned(7), kForeign}, {2, 2, 2});
  border.active.insert(owned(0));
  border.active.insert(owned(1));
  // 4, which has no star, is a vertex next to 1.
  const std::vector<Row> found = border.found();
  CHECK(std::count(found.begin(), found.end(), owned(2)) == 1);
  CHECK(std::count(found.begin(), found.end(), owned(3)) == 1);
  CHECK(std::count(found.begin(), found.end(), kForeign) == 1);
  CHECK_FALSE(border.active.contains(owned(5)));
  CHECK_FALSE(border.active.contains(owned(7)));
  CHECK(border.found().empty());
}

TEST_CASE("a foreign star that is not measured yet makes no triangle inconsistent") {
  Border border;
  border.add(0, {kForeign, owned(1), owned(2)}, {0, 0, 0});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  border.is_measured[1] = 0;
  CHECK(border.found().empty());
  border.is_measured[1] = 1;  // it sent nothing: it lacks both triangles
  CHECK(border.found() == std::vector{owned(1), owned(2)});
}

TEST_CASE("an active point of another tile has the triangles that it sent, and no other") {
  Border border;
  border.add(0, {kForeign, owned(1), owned(2)}, {0, 0, 0});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  SECTION("both sent") {
    border.remote_triangles = {{0, 0, kForeign, owned(1)}, {0, 0, kForeign, owned(2)}};
    CHECK(border.found().empty());
    CHECK(border.growth().wedges().empty());
  }
  SECTION("one sent") {
    border.add(1, {owned(2), owned(0), kForeign}, {0, 0, 3});
    border.add(2, {owned(1), owned(0), owned(7)}, {0, 2, 2.5});
    border.remote_triangles = {
        {0, 0, kForeign, owned(1)}, {1, 0, kForeign, owned(0)}, {3, 0, kForeign, owned(2)}};
    CHECK(border.found() == std::vector{owned(1), owned(2), owned(7)});
    // Triangles (0, 1, 2) and (0, 1, foreign) are consistent.
    const std::vector<Wedge> wedges = border.growth().wedges();
    REQUIRE(wedges.size() == 3);
    const Row ends[][3] = {
        {owned(0), owned(2), kForeign}, {owned(1), kForeign, owned(2)}, {owned(2), owned(0), owned(1)}};
    const float excesses[] = {0, 3, 2.5};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(wedges[i].point.row == ends[i][0]);
      CHECK(wedges[i].from == ends[i][1]);
      CHECK(wedges[i].to == ends[i][2]);
      CHECK(wedges[i].excess == excesses[i]);
    }
  }
  SECTION("none sent") {
    CHECK(border.found() == std::vector{owned(1), owned(2)});
    CHECK(border.growth().wedges().empty());  // nothing is consistent
  }
}

TEST_CASE("a point has a remote triangle if any foreign star has one with it") {
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
