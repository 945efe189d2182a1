// SPDX-License-Identifier: Apache-2.0
// The largest gaps between the directions of a batch's neighbours in their tangent planes (paper, 4.2).
//
// Directions are sorted in single precision. Where the largest gap exceeds all others by more than the
// possible error, its size is taken in double precision. Elsewhere the point is ambiguous, and the exact
// fallback finds its gap. Which way is taken depends on the point alone.
#if defined(LACUNA_CRITERIA_LARGEST_GAPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_LARGEST_GAPS_INL
#undef LACUNA_CRITERIA_LARGEST_GAPS_INL
#else
#define LACUNA_CRITERIA_LARGEST_GAPS_INL
#endif

#include "engine/criteria/exact_fallback.hpp"
#include "engine/criteria/slice-inl.hpp"
#include "engine/simd/maths-inl.hpp"
#include "engine/simd/sort-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

struct TangentPlanes {
  Batch<double> normals[3];  // unit; NaN: no normal, and no gap
  double cos_cone;           // neighbours with |<n, q - p>| > cos_cone |q - p| have no stable direction
};

// As in `Gap`.
struct BatchGaps {
  Batch<double> size, used, near, far;
};

namespace {

using Single = hn::Vec<Floats>;
using Whole = hn::RebindToSigned<Floats>;
constexpr Floats kFloats;
constexpr Whole kWhole;

// A direction as one whole number: its angle in parts of a turn above the neighbour's rank, above kNoTurn.
// As a number of single precision it is sorted; without a direction: infinite.
constexpr std::int32_t kRanks = 64;
constexpr std::int32_t kTurn = 1 << 30;
constexpr std::int32_t kNoTurn = 1 << 29;  // nothing below is a normal number
constexpr std::int32_t kInfinite = 0x7f800000;

// Two turns are ambiguous if they differ by no more than this. A direction is wrong by at most 1e-6 of a
// radian. Its angle and quotient in single precision give 4e-7, the cut to 2^-24 turns 4e-7, and the number
// below as much. A turn is wrong by twice the sum. A difference of two turns is wrong by four times the sum:
// 4e-6. The limit is 1.2e-5.
constexpr std::int32_t kAmbiguousTurn = 2048;

// Below this difference, in units of the squared distance, it is ambiguous whether a neighbour is within the
// cone around the normal.
constexpr float kAmbiguousCone = 1e-5F;

// A point with a neighbour nearer than 1e-10 of the mean distance is ambiguous: nothing underflows here.
constexpr float kNearestSquared = 1e-20F;

// A neighbour in the tangent plane, in units of r_p.
struct Projection {
  Batch<float> x, y, squared_distance;
};

// Projects the first `ranks` neighbours.
void project(const Slice& slice, const Frame<V>& frame, std::size_t ranks, Projection* projections) {
  const hn::Rebind<float, Doubles> single;
  const NeighbourBatch& batch = slice.batch;
  const V unit = all<V>(1) / slice.get(batch.mean_distance);
  const Vector<V> u = frame.u * unit, v = frame.v * unit;
  const auto store = [&](Batch<float>& numbers, V values) HWY_ATTR {
    hn::Store(hn::DemoteTo(single, values), single, numbers.at + slice.first);
  };
  for (std::size_t i = 0; i < ranks; ++i) {
    const Vector<V> offset = slice.offset(i);
    store(projections[i].x, dot(u, offset));
    store(projections[i].y, dot(v, offset));
    store(projections[i].squared_distance, slice.get(batch.squared_distance[i]) * (unit * unit));
  }
}

// Returns the angle of the direction (x, y) from 0 to 1, in turns, to 5e-8; (0, 0) gives 0. Abramowitz and
// Stegun, 4.4.49.
HWY_INLINE Single turn_of(Single y, Single x) {
  const Single zero = all<Single>(0), ax = hn::Abs(x), ay = hn::Abs(y);
  const Single large = hn::Max(ax, ay), small = hn::Min(ax, ay);
  const Single t = small / hn::Max(large, all<Single>(1e-30));
  const Single p = polynomial(t * t, 0.0028662257F, -0.0161657367F, 0.0429096138F, -0.0752896400F,
                              0.1065626393F, -0.1420889944F, 0.1999355085F, -0.3333314528F, 1.0F);
  Single turn = p * t * all<Single>(0.5 / std::numbers::pi);
  turn = hn::IfThenElse(ay > ax, all<Single>(0.25) - turn, turn);
  turn = hn::IfThenElse(x < zero, all<Single>(0.5) - turn, turn);
  return hn::IfThenElse(y < zero, all<Single>(1) - turn, turn);
}

// The neighbours between which the largest gap lies, by rank, in the order of turning.
struct Between {
  Batch<std::int32_t> from, to, used, is_ambiguous;
};

void find_between(const Projection* projections, std::size_t ranks, float squared_sine, std::size_t first,
                  Batch<float>* directions, Between& between) {
  const auto whole = [](std::int32_t number) HWY_ATTR { return hn::Set(kWhole, number); };
  const auto load = [&](const Batch<float>& numbers)
                        HWY_ATTR { return hn::Load(kFloats, numbers.at + first); };
  auto used = hn::Zero(kWhole);
  auto ambiguous = hn::FirstN(kFloats, 0);
  for (std::size_t i = 0; i < ranks; ++i) {
    const Single x = load(projections[i].x), y = load(projections[i].y),
                 squared_distance = load(projections[i].squared_distance);
    const Single outside = (x * x + y * y) - all<Single>(squared_sine) * squared_distance;
    const auto is_used = hn::RebindMask(kWhole, outside > hn::Zero(kFloats));
    ambiguous = hn::Or(ambiguous, hn::Abs(outside) < all<Single>(kAmbiguousCone) * squared_distance);
    used = used - hn::VecFromMask(kWhole, is_used);
    const Single turn = hn::IfThenElseZero(hn::RebindMask(kFloats, is_used), turn_of(y, x));
    const auto step = hn::ConvertTo(kWhole, turn * all<Single>(kTurn / kRanks));
    static_assert(kRanks == 1 << 6);
    const auto direction = hn::ShiftLeft<6>(step) + whole(kNoTurn + static_cast<std::int32_t>(i));
    hn::Store(hn::BitCast(kFloats, hn::IfThenElse(is_used, direction, whole(kInfinite))), kFloats,
              directions[i].at + first);
  }
  const auto is_near = hn::Not(load(projections[0].squared_distance) > all<Single>(kNearestSquared));
  auto is_ambiguous = hn::Or(hn::RebindMask(kWhole, hn::Or(ambiguous, is_near)), used < whole(2));

  sort_lanes(kFloats, directions, ranks, first);
  const auto direction_at = [&](std::size_t rank)
                                HWY_ATTR { return hn::BitCast(kWhole, load(directions[rank])); };
  const auto start = direction_at(0);
  auto here = start, from = hn::Zero(kWhole), to = from, largest = from, second = from,
       smallest = whole(kTurn);
  const auto compare = [&](hn::Vec<Whole> next, hn::Vec<Whole> turn) HWY_ATTR {
    const auto is_larger = turn > largest;
    from = hn::IfThenElse(is_larger, here, from);
    to = hn::IfThenElse(is_larger, next, to);
    second = hn::Max(second, hn::Min(turn, largest));
    largest = hn::Max(largest, turn);
  };
  for (std::size_t i = 1; i < ranks; ++i) {
    const auto next = direction_at(i), turn = next - here;
    const auto is_there = next != whole(kInfinite);
    compare(next, hn::IfThenElseZero(is_there, turn));
    smallest = hn::Min(smallest, hn::IfThenElse(is_there, turn, whole(kTurn)));
    here = hn::IfThenElse(is_there, next, here);
  }
  const auto across = start - here + whole(kTurn);
  compare(start, across);
  smallest = hn::Min(smallest, across);
  is_ambiguous =
      hn::Or(is_ambiguous, hn::Or(smallest<whole(kAmbiguousTurn), second> largest - whole(kAmbiguousTurn)));

  const auto store = [&](Batch<std::int32_t>& numbers, hn::Vec<Whole> values)
                         HWY_ATTR { hn::Store(values, kWhole, numbers.at + first); };
  store(between.from, hn::And(from, whole(kRanks - 1)));
  store(between.to, hn::And(to, whole(kRanks - 1)));
  store(between.used, used);
  store(between.is_ambiguous, hn::VecFromMask(kWhole, is_ambiguous));
}

void measure_gaps(const Slice& slice, const Frame<V>& frame, const Between& between, BatchGaps& gaps) {
  const auto offset = [&](const Batch<std::int32_t>& ranks) HWY_ATTR {
    return slice.offset_at(hn::Load(Slice::Ranks(), ranks.at + slice.first));
  };
  const Vector<V> from = offset(between.from), to = offset(between.to);
  const V x = dot(frame.u, from), y = dot(frame.v, from);
  const V to_x = dot(frame.u, to), to_y = dot(frame.v, to);
  const V turn = angle_of(x * to_y - y * to_x, x * to_x + y * to_y);
  slice.set(gaps.size, hn::IfThenElse(turn < all<V>(0), turn + all<V>(2 * std::numbers::pi), turn));
}

void find_largest_gaps(const NeighbourBatch& batch, const TangentPlanes& planes, BatchGaps& gaps) {
  constexpr auto kMost = static_cast<std::size_t>(kRanks);
  const std::size_t ranks = batch.ranks < kMost ? batch.ranks : kMost;
  Projection projections[kMost];
  Batch<float> directions[kMost];
  Between between;
  Frame<V> frames[kSlices];
  for (std::size_t i = 0; i < kSlices; ++i) {
    const Slice slice{batch, i * kLanes<Doubles>};
    frames[i] = frame_of(slice.get(planes.normals));
    project(slice, frames[i], ranks, projections);
  }
  const double cosine = planes.cos_cone, squared_sine = cosine < 1 ? 1 - cosine * cosine : 0;
  for (std::size_t first = 0; first < kBatchSize; first += kLanes<Floats>)
    find_between(projections, ranks, static_cast<float>(squared_sine), first, directions, between);
  for (std::size_t i = 0; i < kSlices; ++i)
    measure_gaps({batch, i * kLanes<Doubles>}, frames[i], between, gaps);

  for (std::size_t point = 0; point < kBatchSize; ++point) {
    const double normal[3] = {planes.normals[0].at[point], planes.normals[1].at[point],
                              planes.normals[2].at[point]};
    const std::int32_t from = between.from.at[point], to = between.to.at[point];
    LargestGap gap;
    if (normal[0] != normal[0]) {
      // There is no gap.
    } else if (between.is_ambiguous.at[point] != 0 || batch.counts.at[point] > static_cast<double>(kMost)) {
      gap = find_largest_gap_exactly(batch, point, normal, planes.cos_cone);
    } else {
      gap = {gaps.size.at[point], static_cast<double>(between.used.at[point]),
             static_cast<double>(from < to ? from : to), static_cast<double>(from < to ? to : from)};
    }
    gaps.size.at[point] = gap.size;
    gaps.used.at[point] = gap.used;
    gaps.near.at[point] = gap.near;
    gaps.far.at[point] = gap.far;
  }
}

}  // namespace

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
