#include "engine/criteria/largest_gaps.hpp"

#include "engine/core/sorting_network.hpp"
#include "engine/criteria/part.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

using Vectors = Vector<Lanes>;

// As many of the eight points as fit, in single precision.
using Few = SinglesOfEight;
using FewBits = SinglesOfEightBits;

// A direction as one whole number: its angle in parts of a turn above the neighbour's row, above kNoTurn.
// As a number of single precision it is sorted; without a direction: infinite.
constexpr std::int32_t kRows = 64;
constexpr std::int32_t kTurn = 1 << 30;
constexpr std::int32_t kNoTurn = 1 << 29;  // nothing below is a normal number
constexpr std::int32_t kInfinite = 0x7f800000;

// Two turns are told apart if they differ by more. A direction is wrong by no more than 1e-6 of a radian
// (angle and its quotient in single precision, 4e-7; cut to 2^-24 turns, 4e-7; the row below, as much), a
// turn by twice, a difference of two by four times that: 4e-6, and this is 1.2e-5.
constexpr std::int32_t kDoubt = 2048;

// Likewise, in units of the squared distance, whether a neighbour is within the cone around the normal.
constexpr float kConeDoubt = 1e-5F;

// A neighbour nearer than 1e-10 of the mean distance is in doubt: nothing underflows here.
constexpr float kNearestSquared = 1e-20F;

// A neighbour in the tangent plane, in units of r_p.
struct Projection {
  float x[kEight], y[kEight], squared_distance[kEight];
};

// Of the first `rows` neighbours.
void project(const Part& part, const Frame<Lanes>& frame, std::size_t rows, Projection* projections) {
  const Bundle& bundle = part.bundle;
  const Lanes unit = 1.0 / part.get(bundle.mean_distance);
  const Vectors u = frame.u * unit, v = frame.v * unit;
  for (std::size_t i = 0; i < rows; ++i) {
    const Vectors offset = part.offset(i);
    Projection& to = projections[i];
    store(to.x + part.first, single(dot(u, offset)));
    store(to.y + part.first, single(dot(v, offset)));
    store(to.squared_distance + part.first, single(part.get(bundle.squared_distance[i]) * (unit * unit)));
  }
}

LACUNA_INLINE Few magnitude(Few x) {
  return reinterpret_cast<Few>(reinterpret_cast<FewBits>(x) & INT32_MAX);
}

// The angle of the direction (x, y) from 0 to 1, in turns, to 5e-8; (0, 0) gives 0. Abramowitz and
// Stegun, 4.4.49.
LACUNA_INLINE Few turn_of(Few y, Few x) {
  const Few ax = magnitude(x), ay = magnitude(y);
  const Few large = larger(ax, ay), small = smaller(ax, ay);
  const Few t = small / larger(large, Few{} + 1e-30F);
  const Few z = t * t;
  Few p = z * 0.0028662257F - 0.0161657367F;
  p = p * z + 0.0429096138F;
  p = p * z - 0.0752896400F;
  p = p * z + 0.1065626393F;
  p = p * z - 0.1420889944F;
  p = p * z + 0.1999355085F;
  p = p * z - 0.3333314528F;
  p = p * z + 1.0F;
  Few turn = p * t * static_cast<float>(0.5 / std::numbers::pi);
  turn = ay > ax ? 0.25F - turn : turn;
  turn = x < 0.0F ? 0.5F - turn : turn;
  return y < 0.0F ? 1.0F - turn : turn;
}

// Which neighbours the largest gap lies between, by row, in the order of turning.
struct Between {
  std::int32_t from[kEight], to[kEight], used[kEight], in_doubt[kEight];
};

void find_between(const Projection* projections, std::size_t rows, float squared_sine, std::size_t first,
                  EightSingles* directions, Between& between) {
  FewBits used{}, in_doubt{};
  for (std::size_t i = 0; i < rows; ++i) {
    const Few x = load_as<Few>(projections[i].x + first), y = load_as<Few>(projections[i].y + first),
              squared_distance = load_as<Few>(projections[i].squared_distance + first);
    const Few outside = (x * x + y * y) - squared_sine * squared_distance;
    const FewBits is_used = outside > 0.0F;
    in_doubt |= magnitude(outside) < kConeDoubt * squared_distance;
    used -= is_used;
    const Few turn = is_used ? turn_of(y, x) : Few{};
    const FewBits step = __builtin_convertvector(turn * static_cast<float>(kTurn / kRows), FewBits);
    const FewBits direction = step * kRows + (kNoTurn + static_cast<std::int32_t>(i));
    store(directions[i].at + first, reinterpret_cast<Few>(is_used ? direction : FewBits{} + kInfinite));
  }
  in_doubt |= ~(load_as<Few>(projections[0].squared_distance + first) > kNearestSquared) | (used < 2);

  LACUNA_LANES::sort_columns(directions, rows, first);
  const auto direction_at = [&](std::size_t row) {
    return reinterpret_cast<FewBits>(load_as<Few>(directions[row].at + first));
  };
  const FewBits start = direction_at(0);
  FewBits here = start, from{}, to{}, largest{}, second{}, smallest = FewBits{} + kTurn;
  const auto look_at = [&](FewBits next, FewBits turn) {
    const FewBits is_larger = turn > largest;
    from = is_larger ? here : from;
    to = is_larger ? next : to;
    second = larger(second, smaller(turn, largest));
    largest = larger(largest, turn);
  };
  for (std::size_t i = 1; i < rows; ++i) {
    const FewBits next = direction_at(i);
    const FewBits is_there = next != kInfinite, turn = next - here;
    look_at(next, turn & is_there);
    smallest = smaller(smallest, is_there ? turn : kTurn + FewBits{});
    here = is_there ? next : here;
  }
  const FewBits across = start - here + kTurn;
  look_at(start, across);
  smallest = smaller(smallest, across);
  in_doubt |= (smallest < kDoubt) | (second > largest - kDoubt);

  store(between.from + first, from & (kRows - 1));
  store(between.to + first, to & (kRows - 1));
  store(between.used + first, used);
  store(between.in_doubt + first, in_doubt);
}

void measure_gaps(const Part& part, const Frame<Lanes>& frame, const Between& between, BundledGaps& gaps) {
  const Vectors from = part.offset_in_rows(between.from + part.first),
                to = part.offset_in_rows(between.to + part.first);
  const Lanes x = dot(frame.u, from), y = dot(frame.v, from);
  const Lanes to_x = dot(frame.u, to), to_y = dot(frame.v, to);
  const Lanes turn = angle_of(x * to_y - y * to_x, x * to_x + y * to_y);
  part.set(gaps.size, select(turn < 0.0, turn + 2 * std::numbers::pi, turn));
}

void set(BundledGaps& gaps, std::size_t point, const GapFit& fit) {
  gaps.size.at[point] = fit.size;
  gaps.used.at[point] = fit.used;
  gaps.near.at[point] = fit.near;
  gaps.far.at[point] = fit.far;
}

}  // namespace

void find_largest_gaps(const Bundle& bundle, const TangentPlanes& planes, BundledGaps& gaps) {
  constexpr auto kMost = static_cast<std::size_t>(kRows);
  const std::size_t rows = bundle.rows < kMost ? bundle.rows : kMost;
  Projection projections[kMost];
  EightSingles directions[kMost];
  Between between;
  Frame<Lanes> frames[kParts];
  for (std::size_t i = 0; i < kParts; ++i) {
    const Part part{bundle, i * kLanes};
    frames[i] = frame_of(part.get(planes.normals));
    project(part, frames[i], rows, projections);
  }
  const double squared_sine = larger(1.0 - planes.cos_cone * planes.cos_cone, 0.0);
  for (std::size_t first = 0; first < kEight; first += kSinglesOfEight)
    find_between(projections, rows, static_cast<float>(squared_sine), first, directions, between);
  for (std::size_t i = 0; i < kParts; ++i) measure_gaps({bundle, i * kLanes}, frames[i], between, gaps);

  for (std::size_t point = 0; point < kEight; ++point) {
    const double normal[3] = {planes.normals[0].at[point], planes.normals[1].at[point],
                              planes.normals[2].at[point]};
    const std::int32_t from = between.from[point], to = between.to[point];
    if (normal[0] != normal[0]) {
      set(gaps, point, {});
    } else if (between.in_doubt[point] != 0 || bundle.counts.at[point] > static_cast<double>(kMost)) {
      set(gaps, point, largest_gap_carefully(bundle, point, normal, planes.cos_cone));
    } else {
      gaps.used.at[point] = between.used[point];
      gaps.near.at[point] = from < to ? from : to;
      gaps.far.at[point] = from < to ? to : from;
    }
  }
}

}  // namespace lacuna::LACUNA_LANES
