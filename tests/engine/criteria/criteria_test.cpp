// SPDX-License-Identifier: Apache-2.0
// Each criterion on its own, on surfaces drawn by hand.
#include "engine/criteria/angle-inl.hpp"
#include "engine/criteria/exact_fallback.hpp"
#include "engine/criteria/halfdisc-inl.hpp"
#include "engine/criteria/shape-inl.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>
#include <Eigen/Geometry>

namespace lacuna {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
constexpr double kNoCone = 2;
constexpr double kNone = -1;

// One point's neighbourhood as the third of a batch.
LargestGap gap_of(const std::vector<Vector3d>& offsets, double cos_cone = kNoCone,
                  const Vector3d& normal = {0, 0, 1}) {
  constexpr std::size_t kPoint = 2;
  std::vector<Batch<double>> x(offsets.size()), y(offsets.size()), z(offsets.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    x[i].at[kPoint] = offsets[i].x();
    y[i].at[kPoint] = offsets[i].y();
    z[i].at[kPoint] = offsets[i].z();
  }
  NeighbourBatch batch{.ranks = offsets.size(), .x = x.data(), .y = y.data(), .z = z.data()};
  batch.counts.at[kPoint] = double(offsets.size());
  return find_largest_gap_exactly(batch, kPoint, normal.data(), cos_cone);
}

// In the plane, at these degrees; nearest first.
std::vector<Vector3d> at_degrees(const std::vector<double>& degrees) {
  std::vector<Vector3d> offsets;
  for (const double d : degrees) {
    const double length = 1 + 0.1 * double(offsets.size());
    offsets.push_back(length * Vector3d(std::cos(d * kPi / 180), std::sin(d * kPi / 180), 0));
  }
  return offsets;
}

TEST_CASE("the largest gap is the one between neighbours side by side, the nearer of them named first") {
  const LargestGap gap = gap_of(at_degrees({200, 0, 90, 300}));
  CHECK(gap.size == Approx(110 * kPi / 180));
  CHECK(gap.near == 0);
  CHECK(gap.far == 2);
  CHECK(gap.used == 4);
}

TEST_CASE("a gap across the jump of the angle is seen") {
  const LargestGap gap = gap_of(at_degrees({-60, 0, 60, 100, -100}));
  CHECK(gap.size == Approx(160 * kPi / 180));
  CHECK((gap.near == 3 && gap.far == 4));
}

TEST_CASE("of equal gaps the one is taken whose neighbours come first") {
  const LargestGap gap = gap_of(at_degrees({180, 0, 270, 90}));
  CHECK(gap.size == Approx(kPi / 2));
  CHECK((gap.near == 0 && gap.far == 2));
}

TEST_CASE("neighbours in one direction are one, the nearest stands for it, across the jump too") {
  for (const double turn : {0.0, 180.0, 77.0}) {
    const LargestGap gap = gap_of(at_degrees({10 + turn, turn, turn + 360, 100 + turn, turn - 360}));
    CHECK(gap.used == 5);
    CHECK((gap.near == 1 && gap.far == 3));
    CHECK(gap.size == Approx(260 * kPi / 180));
  }
  const LargestGap one = gap_of(at_degrees({45, 45, 45}));
  CHECK(one.size == Approx(2 * kPi));
  CHECK((one.near == 0 && one.far == 0 && one.used == 3));
}

TEST_CASE("without a direction there is no gap: no neighbours, or all along the normal") {
  CHECK(gap_of({}).near == kNone);
  const LargestGap along = gap_of({{0, 0, 1}, {0, 0, -2}});
  CHECK((along.used == 0 && along.near == kNone && along.far == kNone));
}

TEST_CASE("directions strictly within the cone about the normal are not used") {
  const double cos_cone = std::cos(45 * kPi / 180);
  const std::vector<Vector3d> offsets = {{1, 0, 0.9}, {0, 1, 1.1}, {-1, 0, -0.9}, {0, -1, -1.1}};
  const LargestGap gap = gap_of(offsets, cos_cone);
  CHECK(gap.used == 2);
  CHECK((gap.near == 0 && gap.far == 2));
  CHECK(gap_of(offsets).used == 4);
}

TEST_CASE("the sign and the place of the normal do not change the gap") {
  const std::vector<Vector3d> flat = at_degrees({200, 0, 90, 300, 40});
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3d> turned;
  for (const Vector3d& offset : flat) turned.push_back(rotation * offset);
  const LargestGap expected = gap_of(flat);
  for (const double sign : {1.0, -1.0}) {
    const LargestGap gap = gap_of(turned, kNoCone, sign * rotation.col(2));
    CHECK(gap.size == Approx(expected.size));
    CHECK((gap.near == expected.near && gap.far == expected.far));
  }
}

// The kernels' formulas, for one point.
namespace formulas = HWY_NAMESPACE;
using OneTag = formulas::hn::CappedTag<double, 1>;
using One = formulas::hn::Vec<OneTag>;

One one(double number) {
  return formulas::hn::Set(OneTag(), number);
}
double number(One one) {
  return formulas::hn::GetLane(one);
}
auto mask(bool is_set) {
  return formulas::hn::FirstN(OneTag(), is_set);
}

formulas::Surface<One> with_gap(double size, double used) {
  formulas::Surface<One> surface{};
  surface.has_normal = mask(true);
  surface.normal = {one(0), one(0), one(1)};
  surface.gap = {one(size), one(used), one(0), one(1)};
  return surface;
}

double angle_probability(const formulas::Surface<One>& surface) {
  return number(formulas::angle_probability(surface));
}
double halfdisc_probability(const formulas::Surface<One>& surface) {
  return number(formulas::halfdisc_probability(surface));
}

TEST_CASE("the angle probability is 0 for even directions, 1 for half a turn, and rises between") {
  CHECK(angle_probability(with_gap(2 * kPi / 8, 8)) == 0);
  CHECK(angle_probability(with_gap(kPi, 8)) == 1);
  CHECK(angle_probability(with_gap(1.5 * kPi, 8)) == 1);
  CHECK(angle_probability(with_gap((2 * kPi / 8 + kPi) / 2, 8)) == Approx(0.5));
  CHECK(angle_probability(with_gap(0.1, 2)) == 1);
  formulas::Surface<One> no_normal = with_gap(0.1, 8);
  no_normal.has_normal = mask(false);
  CHECK(angle_probability(no_normal) == 1);
}

TEST_CASE("the halfdisc probability is 1 where the mean lies at the centroid of a half disc or beyond") {
  formulas::Surface<One> surface = with_gap(1, 8);
  surface.mean_distance = one(3);
  const double centroid = 4 * 3 / (3 * kPi);
  for (const double share : {0.0, 0.25, 1.0, 1.5}) {
    surface.mean_offset = {one(share * centroid), one(0),
                           one(17)};  // what lies along the normal does not count
    CHECK(halfdisc_probability(surface) == Approx(std::min(share, 1.0)));
  }
  surface.has_normal = mask(false);
  CHECK(halfdisc_probability(surface) == 1);
}

TEST_CASE("the shape probability is largest at the boundary's eigenvalues, small at the other three shapes") {
  const auto shape = [](double a, double b, double c) {
    formulas::Surface<One> surface{};
    surface.eigenvalues = {one(a), one(b), one(c)};
    surface.shape = formulas::shape_shares(surface);
    CHECK(number(surface.shape.surface) >= number(formulas::shape_probability(surface)));
    return number(formulas::shape_probability(surface));
  };
  const auto surface_share = [](double a, double b, double c) {
    formulas::Surface<One> surface{};
    surface.eigenvalues = {one(a), one(b), one(c)};
    return number(formulas::shape_shares(surface).surface);
  };
  for (const double on_surface : {surface_share(2, 1, 0), surface_share(1, 1, 0)}) CHECK(on_surface > 0.9);
  for (const double off : {surface_share(1, 1, 1), surface_share(1, 0, 0)}) CHECK(off < 0.1);
  const double boundary = shape(2, 1, 0);
  CHECK(boundary > 0.7);
  for (const double other : {shape(1, 1, 0), shape(1, 1, 1), shape(1, 0, 0)}) CHECK(other < boundary / 2);
  CHECK(shape(2e9, 1e9, 0) == Approx(boundary));
  CHECK(shape(2, 1, -1e-17) == Approx(boundary));
  CHECK(shape(0, 0, 0) == shape(1, 1, 1));
}

}  // namespace
}  // namespace lacuna
