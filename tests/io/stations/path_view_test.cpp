// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/path_view.hpp"

#include "io/explain/stations/find_causes.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

// A scanner drives from 0 to 20 along x, 2 over a floor, and turns around its path. A wall stands at y = 5,
// with a window, and a screen before a part of it.
double range_of(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  double nearest = 0;
  const auto hit = [&](int axis, double at, const std::function<bool(const Eigen::Vector3d&)>& is_there) {
    const double range = (at - eye[axis]) / direction[axis];
    if (!(range > 0) || (nearest > 0 && nearest < range) || !is_there(eye + range * direction)) return;
    nearest = range;
  };
  hit(2, 0, [](const auto& p) { return std::fabs(p.y()) < 20; });
  hit(1, 5, [](const auto& p) {
    const bool is_window = p.x() > 4 && p.x() < 6 && p.z() > 1 && p.z() < 3;
    return p.z() > 0 && p.z() < 6 && !is_window;
  });
  hit(1, 9, [](const auto& p) { return p.z() > 0 && p.z() < 4; });  // behind the wall
  hit(1, 2.5, [](const auto& p) { return p.x() > 12 && p.x() < 15 && p.z() > 0 && p.z() < 1.5; });
  return nearest;
}

// Times are from `start` on, in these steps where there are steps.
void measure(PathView& view, bool is_reversed = false, double start = 100, double step = 0) {
  constexpr int kProfiles = 400, kRays = 720;
  for (int i = 0; i < kProfiles; ++i) {
    const int profile = is_reversed ? kProfiles - 1 - i : i;
    const Eigen::Vector3d eye(20.0 * profile / kProfiles, 0, 2);
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2 * std::numbers::pi * (ray + 0.5) / kRays;
      const Eigen::Vector3d direction(0, std::cos(angle), std::sin(angle));
      const double range = range_of(eye, direction);
      const double since = 2.0 * profile / kProfiles;
      const double time = start + (step > 0 ? std::floor(since / step) * step : since);
      if (range > 0 && range < 15) view.add(time, eye + range * direction, true);
    }
  }
  view.complete();
}

class Drive {
 public:
  explicit Drive(double start = 100)
      : view({{start, start + 2}, {{0, 0, 2}, {20, 0, 2}}}, "path.txt", 1, folder_.path(), 1 << 20) {}

  // A square of edge 1 in a plane with this normal.
  LoopCause cause_at(const Eigen::Vector3d& middle, int normal) const {
    std::vector<Eigen::Vector3d> loop(4, middle);
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    loop[0][u] -= 0.5, loop[1][v] -= 0.5, loop[2][u] += 0.5, loop[3][v] += 0.5;
    return cause_of(inside_places(loop), {}, &view, 0.1);
  }

 private:
  ScratchFolder folder_;

 public:
  PathView view;
};

}  // namespace

TEST_CASE("a moving scanner says why a place has no points") {
  Drive drive;
  measure(drive.view);
  CHECK(drive.view.certainty() == 1);
  CHECK(drive.cause_at({5, 5, 2}, 1).share(Cause::kOpening) > 0.95);  // the window
  const LoopCause hidden = drive.cause_at({13.5, 5, 0.6}, 1);         // behind the screen
  CHECK(hidden.share(Cause::kHidden) > 0.95);
  CHECK(hidden.hidden_by.y() == Approx(2.5).margin(0.1));
  CHECK(hidden.hidden_from_place.x() == Approx(13.5).margin(0.3));
  CHECK(hidden.hidden_from == 0);
  CHECK(drive.cause_at({21.5, 5, 2}, 1).share(Cause::kOutOfView) == 1);  // past the end of the path
  CHECK_FALSE(drive.cause_at({9, 5, 4}, 1).main());                      // has points
}

TEST_CASE("what a moving scanner says depends neither on the order of points nor on last digits of times") {
  Drive forward, backward(1.7e9);
  measure(forward.view);
  measure(backward.view, true, 1.7e9);
  for (const double x : {3.9, 4.1, 5.0, 5.8, 12.2, 13.5, 14.9})
    CHECK(forward.cause_at({x, 5, 1.2}, 1).shares == backward.cause_at({x, 5, 1.2}, 1).shares);
  CHECK(forward.view.farthest() == Approx(backward.view.farthest()));
}

TEST_CASE("times in steps in which a scanner moves are coarse, and with one time for all it does not count") {
  Drive coarse, one;
  measure(coarse.view, false, 100, 0.05);
  measure(one.view, false, 101, 3);
  CHECK(coarse.view.summary().coarse_step == Approx(0.05));
  CHECK(std::isinf(one.view.summary().coarse_step));
  CHECK(one.view.certainty() == 0);
}

TEST_CASE("points without a time of the path make a moving scanner uncertain, and then it gives no cause") {
  Drive drive;
  for (int i = 0; i < 20'000; ++i) drive.view.add(99, {1, 2, 3}, true);
  measure(drive.view);
  CHECK(drive.view.certainty() < StationView::kLeastCertain);
  CHECK(drive.view.summary().untimed == 20'000);
  CHECK_FALSE(drive.cause_at({5, 5, 2}, 1).main());
}

TEST_CASE("a path beside the places of the scanner is not certain, near or far") {
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0, 30, 0), {0, 300, 0}, {300, 0, 0}, {0, 0, 3e6}}) {
    INFO(off);
    const ScratchFolder folder;
    PathView view({{100, 102}, {Eigen::Vector3d(0, 0, 2) + off, Eigen::Vector3d(20, 0, 2) + off}}, "path.txt",
                  1, folder.path(), 1 << 20);
    measure(view);
    CHECK(view.certainty() < StationView::kLeastCertain);
    CHECK(view.summary().certainty == view.certainty());
  }
}

// 7 / (7 * 0.02) is less than 50 in floating point, 7 / 0.02 is 350.
TEST_CASE("a point at the very end of a path is measured from a section of it") {
  const ScratchFolder folder;
  PathView view({{100, 102}, {{0, 0, 0}, {7, 0, 0}}}, "path.txt", 1, folder.path(), 1 << 20);
  const Eigen::Vector3d point(7, 14.5, 0);
  view.add(102, point, true);
  view.complete();
  CHECK(view.sections_near({point, point}, 20) == std::vector<std::uint32_t>{50});
}

TEST_CASE("a path at other times than all points is an error that names both") {
  Drive drive;
  drive.view.add(7, {1, 2, 3}, true);
  CHECK_THROWS_WITH(drive.view.complete(),
                    Contains("path.txt") && Contains("7 to 7") && Contains("100 to 102"));
}

}  // namespace lacuna::io
