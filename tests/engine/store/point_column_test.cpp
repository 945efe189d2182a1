// SPDX-License-Identifier: Apache-2.0
// Points on disk come back as they were, in either precision.
#include "engine/store/point_column.hpp"

#include "engine/run/error.hpp"
#include "engine/survey/survey.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cmath>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::vector<ScanPoint> drawn_points(std::size_t count, bool is_single) {
  Random random(count);
  std::vector<ScanPoint> points;
  const auto number = [&] {
    const double x = random.uniform(-1e6, 1e6);
    return is_single ? static_cast<double>(static_cast<float>(x)) : x;
  };
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({number(), number(), number(), PointId{(std::uint64_t{1} << 32) - 1 - i}});
  return points;
}

bool same(const ScanPoint& a, const ScanPoint& b) {
  return a.position() == b.position() && a.id == b.id;
}

SurveyedScan surveyed(const PointBatch& batch) {
  Survey survey(1 << 20, batch.size());
  survey.add(batch);
  return survey.finish();
}

TEST_CASE("points come back from disk as they were, whatever the precision and the parts they are read in") {
  for (const Precision precision : {Precision::kSingle, Precision::kDouble}) {
    const test::ScratchFolder folder;
    PointColumn column(StoreFile(folder / "points"), precision);
    const std::vector<ScanPoint> points = drawn_points(20'000, precision == Precision::kSingle);
    Random random(5);
    std::size_t wrong = 0;
    for (std::size_t begin = 0, end; begin < points.size(); begin = end) {
      end = std::min(points.size(), begin + std::size_t(random.whole(1, 9000)));
      column.write(100 + begin, std::span(points).subspan(begin, end - begin));
    }
    for (int round = 0; round < 50; ++round) {
      const auto begin = std::size_t(random.whole(0, 19'999));
      const auto count = std::size_t(random.whole(0, std::int64_t(points.size() - begin)));
      const std::vector<ScanPoint> found = column.read(100 + begin, count);
      REQUIRE(found.size() == count);
      for (std::size_t i = 0; i < count; ++i) wrong += !same(found[i], points[begin + i]);
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("what single precision would lose is not written in it") {
  const test::ScratchFolder folder;
  PointColumn column(StoreFile(folder / "points"), Precision::kSingle);
  const ScanPoint good{0.5, -3, 1e30f, PointId{7}};
  CHECK_NOTHROW(column.write(0, std::vector{good}));
  for (const ScanPoint& bad :
       {ScanPoint{0.1, 0, 0, PointId{7}}, ScanPoint{0, 1e300, 0, PointId{7}},
        ScanPoint{0, 0, 1 + 1e-9, PointId{7}}, ScanPoint{0, 0, 0, PointId{std::uint64_t{1} << 32}}})
    CHECK_THROWS_AS(column.write(0, std::vector{good, bad}), Error);
}

TEST_CASE("a scan is of single precision if all of its finite coordinates are") {
  PointBatch batch{.positions = {{0.5, 1, 2}, {-0.0, 3, 1e-3f}, {NAN, 0.1, 0}, {0.1, INFINITY, 0}}};
  CHECK(surveyed(batch).precision() == Precision::kSingle);
  batch.positions.emplace_back(0.1, 0, 0);
  CHECK(surveyed(batch).precision() == Precision::kDouble);
  CHECK(SurveyTotals{.ids = (std::uint64_t{1} << 32) + 1}.precision() == Precision::kDouble);
}

}  // namespace
}  // namespace lacuna
