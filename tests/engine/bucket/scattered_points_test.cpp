// SPDX-License-Identifier: Apache-2.0
// Points on their way to their places, in memory and on disk.
#include "engine/bucket/scattered_points.hpp"

#include "engine/run/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/tiled_scan.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr std::uint64_t kPoints = 400'000, kPlaces = 7;

ScanPoint numbered(std::uint64_t id) {
  return {double(id), 0.5, -1, PointId{id}};
}

TEST_CASE("points that come from several threads are at their places once each, with their normals") {
  for (const PointForm form : {PointForm{Precision::kSingle, false}, PointForm{Precision::kSingle, true},
                               PointForm{Precision::kDouble, false}, PointForm{Precision::kDouble, true}}) {
    Config config;
    config.run.memory_limit = std::uint64_t{64} << 20;  // most points are on disk
    TiledScan scan(plane(4), config);
    ScatteredPoints scattered(kPlaces, form, scan.job);
    std::vector<std::thread> threads;
    for (std::uint64_t first = 0; first < 4; ++first) {
      threads.emplace_back([&, first] {
        for (std::uint64_t id = first * 100; id < kPoints; id += 400) {
          std::vector<ScanPoint> points;
          std::vector<PlainNormal> normals;
          for (std::uint64_t i = id; i < id + 100; ++i) {
            points.push_back(numbered(i));
            if (form.with_normals) normals.push_back({double(i), 1, 2});
          }
          scattered.add(id / 100 % kPlaces, points, normals);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    std::vector<std::uint64_t> ids;
    std::size_t wrong = 0;
    for (std::size_t place = 0; place < scattered.places(); ++place) {
      scattered.for_each(place, [&](const PointsAndNormals& some) {
        wrong += form.with_normals != (some.normals.size() == some.points.size());
        for (std::size_t i = 0; i < some.points.size(); ++i) {
          const ScanPoint& p = some.points[i];
          ids.push_back(value(p.id));
          wrong += p.position() != numbered(value(p.id)).position() || value(p.id) / 100 % kPlaces != place;
          if (form.with_normals) wrong += some.normals[i][0] != p.x || some.normals[i][2] != 2;
        }
      });
    }
    CHECK(wrong == 0);
    REQUIRE(ids.size() == kPoints);
    std::sort(ids.begin(), ids.end());
    for (std::uint64_t i = 0; i < kPoints; ++i) wrong += ids[i] != i;
    CHECK(wrong == 0);
  }
}

TEST_CASE("a point that single precision would change is an error") {
  const PointForm form{Precision::kSingle, false};
  const std::vector<ScanPoint> points = {numbered(1), {0.1, 0, 0, PointId{2}}};
  CHECK_THROWS_WITH(form.pack(points, {}), Catch::Contains("more digits than before"));
  CHECK(form.pack({points.data(), 1}, {}).size() == form.record_bytes());
}

}  // namespace
}  // namespace lacuna
