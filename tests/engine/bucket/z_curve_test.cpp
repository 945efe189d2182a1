// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/z_curve.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::vector<ZPlace> ordered(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const ZCurve curve(box);
  std::vector<ZPlace> places;
  for (const Eigen::Vector3d& p : points) places.push_back(curve.place(p));
  std::sort(places.begin(), places.end(), comes_before);
  return places;
}

TEST_CASE("the curve goes through the eight corners of a cube by x, then y, then z") {
  const ZCurve curve(Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)));
  ZPlace before = curve.place({0, 0, 0});
  for (int corner = 1; corner < 8; ++corner) {
    const ZPlace place = curve.place({double(corner >> 2 & 1), double(corner >> 1 & 1), double(corner & 1)});
    CHECK(comes_before(before, place));
    CHECK_FALSE(comes_before(place, before));
    CHECK_FALSE(comes_before(place, place));
    before = place;
  }
}

TEST_CASE("runs hold all places in order, none too many, and a run ends where the curve changes halves") {
  const std::vector<ZPlace> places = ordered(random_cloud(3).positions);
  for (const std::size_t most : {1, 7, 32, 100'000}) {
    const std::vector<std::uint32_t> ends = cut_runs(places, most);
    std::uint32_t begin = 0;
    for (const std::uint32_t end : ends) {
      CHECK(end > begin);
      CHECK(end - begin <= most);
      begin = end;
    }
    CHECK(begin == places.size());
  }
  CHECK(cut_runs({}, 5).empty());
  CHECK(cut_runs(std::vector<ZPlace>{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {std::uint64_t{1} << 40, 0, 0}}, 3) ==
        std::vector<std::uint32_t>{3, 4});
  CHECK(cut_runs(std::vector<ZPlace>(10, ZPlace{5, 5, 5}), 4) == std::vector<std::uint32_t>{4, 8, 10});
}

TEST_CASE("places are those of the nearest side outside of the box, and one place in a box of one point") {
  const ZCurve curve(Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 1, 1)));
  CHECK(curve.place({-5, 0.5, 0}) == curve.place({0, 0.5, 0}));
  CHECK(curve.place({1e300, 0.5, 0}) == curve.place({2, 0.5, 0}));
  const Eigen::Vector3d point(3, 4, 5);
  CHECK(ZCurve(Eigen::AlignedBox3d(point, point)).place(point) == ZPlace{});
  CHECK(ZCurve(Eigen::AlignedBox3d()).place(point) == ZPlace{});
}

}  // namespace
}  // namespace lacuna
