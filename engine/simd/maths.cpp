// SPDX-License-Identifier: Apache-2.0
#include "engine/simd/maths.hpp"

#include "engine/simd/maths-inl.hpp"

namespace lacuna {
namespace {

namespace target = HWY_NAMESPACE;
using One = target::hn::CappedTag<double, 1>;

auto one(double x) {
  return target::hn::Set(One(), x);
}

}  // namespace

double exponential(double x) {
  return target::hn::GetLane(target::exponential(one(x)));
}

double angle_of(double y, double x) {
  return target::hn::GetLane(target::angle_of(one(y), one(x)));
}

double cosine(double x) {
  constexpr double kThird = std::numbers::pi / 3;
  return x <= kThird ? target::hn::GetLane(target::sine_and_cosine(one(x)).cosine)
                     : target::hn::GetLane(target::sine_and_cosine(one(std::numbers::pi / 2 - x)).sine);
}

}  // namespace lacuna
