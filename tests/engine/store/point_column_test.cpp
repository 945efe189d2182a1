// SPDX-License-Identifier: Apache-2.0
// Points on disk come back as they were, in either precision.
#include "engine/store/point_column.hpp"

#include "engine/survey/survey.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

SurveyedScan surveyed(const PointBatch& batch) {
  const ScratchFolder folder;
  Survey survey(1 << 20, batch.size(), folder / "cells");
  survey.add(batch);
  return survey.finish();
}

TEST_CASE("what single precision would lose is not written in it") {
  const ScratchFolder folder;
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
