// SPDX-License-Identifier: Apache-2.0
// Stars along the border of a tile: active points found with what other tiles sent, and the wedges left.
#include "engine/boundary/tangential/growth.hpp"

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna::tangential {
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

  // `radii` of the triangles that begin at each link vertex: the fine bound is 1, the coarse one 2. Link
  // vertex i is at a distance of i + 1.
  void add(LocalIndex p, const std::vector<Row>& link, const std::vector<float>& radii) {
    const RadiusBound bound{1, 2};
    stars.stars.push_back({{{0, 0, 0, PointId{p}}, {}, 0},
                           p,
                           {static_cast<std::uint32_t>(stars.vertices.size()), 0, bound},
                           10,
                           {5, 8}});
    for (std::size_t i = 0; i < link.size(); ++i) {
      const Scale scale = bound.scale_of(radii[i]);
      stars.add_vertex({{link[i], double(i + 1)}, radii[i], {scale, scale != Scale::kNone}});
    }
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
  // The star of 1 lacks the triangle (0, 1, 2) of 0. The circumradius between 3 and the foreign point is too
  // large for a triangle of 2. The star of 5 is not reached.
  border.add(0, {owned(1), owned(2), owned(4)}, {1, 1, 1});
  border.add(1, {owned(4), owned(3), owned(6)}, {1, 1, 1});
  border.add(2, {owned(3), kForeign, owned(0)}, {3, 1, 1});
  border.add(5, {owned(6), owned(7), kForeign}, {3, 3, 3});
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
  border.add(0, {kForeign, owned(1), owned(2)}, {1, 1, 1});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  border.is_measured[1] = 0;
  CHECK(border.found().empty());
  border.is_measured[1] = 1;  // it sent nothing: it lacks both triangles
  CHECK(border.found() == std::vector{owned(1), owned(2)});
}

TEST_CASE("an active point of another tile has the triangles that it sent, and no other") {
  Border border;
  border.add(0, {kForeign, owned(1), owned(2)}, {1, 1, 1});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  SECTION("both sent") {
    border.remote_triangles = {{0, Scale::kFine, kForeign, owned(1)}, {0, Scale::kFine, kForeign, owned(2)}};
    CHECK(border.found().empty());
    CHECK(border.growth().wedges({}).empty());
  }
  SECTION("one sent") {
    border.add(1, {owned(2), owned(0), kForeign}, {1, 1, 4});
    border.add(2, {owned(1), owned(0), owned(7)}, {1, 3, 3.5});
    border.remote_triangles = {{0, Scale::kFine, kForeign, owned(1)},
                               {1, Scale::kFine, kForeign, owned(0)},
                               {3, Scale::kFine, kForeign, owned(2)}};
    CHECK(border.found() == std::vector{owned(1), owned(2), owned(7)});
    // Triangles (0, 1, 2) and (0, 1, foreign) are consistent.
    // Each is alike at both scales.
    const std::vector<Wedge> wedges = border.growth().wedges({.clear_radius = 9});
    REQUIRE(wedges.size() == 6);
    const Row ends[][3] = {
        {owned(0), owned(2), kForeign}, {owned(1), kForeign, owned(2)}, {owned(2), owned(0), owned(1)}};
    const double lengths[] = {(3 + 1) / 2., (3 + 1) / 2., (2 + 1) / 2.}, radii[] = {10, 40, 35};
    for (std::size_t i = 0; i < 6; ++i) {
      const Scale scale = i % 2 == 0 ? Scale::kFine : Scale::kCoarse;
      const double sampling_radius = i % 2 == 0 ? 5 : 8;
      CHECK(wedges[i].row == ends[i / 2][0]);
      CHECK(wedges[i].from == ends[i / 2][1]);
      CHECK(wedges[i].to == ends[i / 2][2]);
      CHECK(wedges[i].scale == scale);
      CHECK(wedges[i].evidence.length == lengths[i / 2]);
      CHECK(wedges[i].evidence.sampling_radius == sampling_radius);
      CHECK(wedges[i].evidence.clearness == static_cast<float>((radii[i / 2] / sampling_radius - 1) / 8));
    }
  }
  SECTION("none sent") {
    CHECK(border.found() == std::vector{owned(1), owned(2)});
    CHECK(border.growth().wedges({}).empty());  // nothing is consistent
  }
}

TEST_CASE("a triangle that another tile sent for the coarse bound is missing within the fine one only") {
  Border border;
  border.add(0, {kForeign, owned(1), owned(2)}, {1, 1.5, 1});
  border.active.insert(owned(0));
  border.active.insert(kForeign);
  border.remote_triangles = {{0, Scale::kCoarse, kForeign, owned(1)}, {0, Scale::kFine, kForeign, owned(2)}};
  CHECK(border.found() == std::vector{owned(1), owned(2)});
  border.add(1, {owned(2), owned(0), kForeign}, {1, 1, 1});
  border.add(2, {owned(1), kForeign, owned(0)}, {1, 1, 1});
  const std::vector<Wedge> wedges = border.growth().wedges({});
  const auto at_0 = [](const Wedge& wedge) { return wedge.row == owned(0); };
  REQUIRE(std::count_if(wedges.begin(), wedges.end(), at_0) == 1);
  const Wedge& wedge = *std::find_if(wedges.begin(), wedges.end(), at_0);
  CHECK(wedge.scale == Scale::kFine);
  CHECK(wedge.from == kForeign);  // from the triangle with 1 around to the one with 2
  CHECK(wedge.to == owned(2));
}

TEST_CASE("a point has a remote triangle if any foreign star has one with it") {
  const std::vector<RemoteTriangle> remote_triangles = {{2, Scale::kFine, kForeign, owned(1)},
                                                        {2, Scale::kFine, kForeign, owned(3)},
                                                        {5, Scale::kFine, kForeign, owned(1)}};
  CHECK_FALSE(has_remote_triangle({}, 2));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 1));
  CHECK(has_remote_triangle(remote_triangles, 2));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 4));
  CHECK(has_remote_triangle(remote_triangles, 5));
  CHECK_FALSE(has_remote_triangle(remote_triangles, 6));
}

}  // namespace lacuna::tangential
