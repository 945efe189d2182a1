#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/boundary/tangential/star_batch.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/boundary/tangential/star_batch.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/load_pair-inl.hpp"
#include "engine/simd/mask_bits-inl.hpp"
#include "engine/boundary/tangential/star-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

using V = hn::Vec<Doubles>;
using Mask = MaskOf<V>;
using Whole = hn::RebindToUnsigned<Doubles>;
using Count = hn::Vec<Whole>;
constexpr Whole kWhole;
constexpr std::size_t kStep = kLanes<Doubles>;

HWY_INLINE Count count(std::size_t number) {
  return hn::Set(kWhole, number);
}

// A view beside an edge by no more than this is on it, in units of the edge's |x| + |y| times the distance of
// the farthest view: 500 times what rounding can do.
constexpr double kOnEdge = 1e-12;

// What rounding can do at most, by a hundred times, in units of the square of that distance.
constexpr double kRounding = 1e-13;

// Comparisons of rows depend on one another: as many at a time do not.
constexpr std::size_t kChains = 4;

// Of as many points as a vector holds, by row.
struct Views {
  View<V> at[kMostSeen];
  std::size_t rows;  // an even number
  V distance;        // `Sampling::distance`
};

// What of a site the stars need.
struct Sites {
  Vector<V> position, shift;
  V closeness, weight;
};
static_assert(sizeof(Site) == 8 * sizeof(double));

HWY_INLINE const double* numbers_of(const Site& site) {
  return reinterpret_cast<const double*>(&site);
}

HWY_INLINE Sites load_sites(const double* const (&sites)[kStep]) {
  const auto [x, y] = load_pair(Doubles(), sites, 0);
  const auto [z, shift_x] = load_pair(Doubles(), sites, 2);
  const auto [shift_y, shift_z] = load_pair(Doubles(), sites, 4);
  const auto [closeness, weight] = load_pair(Doubles(), sites, 6);
  return {{x, y, z}, {shift_x, shift_y, shift_z}, closeness, weight};
}

// Of points `first` and the next. A neighbour that a point has not is at an offset of 0.
void find_views(const StarBatch& batch, std::size_t first, Views& views) {
  const double* points[kStep];
  double counts[kStep];
  std::size_t common = views.rows;
  for (std::size_t i = 0; i < kStep; ++i) {
    points[i] = numbers_of(batch.sites[batch.points[first + i]]);
    counts[i] = batch.counts[first + i];
    common = batch.counts[first + i] < common ? batch.counts[first + i] : common;
  }
  const auto normal = [&](int axis) HWY_ATTR { return hn::LoadU(Doubles(), batch.normals[axis] + first); };
  const Frame<V> frame = frame_of(Vector<V>{normal(0), normal(1), normal(2)});
  const Sites at = load_sites(points);
  const V all_counts = hn::LoadU(Doubles(), counts);
  V sum = at.closeness;
  const double* row_of[kStep];
  std::size_t row = 0;
  for (; row < common; ++row) {
    for (std::size_t i = 0; i < kStep; ++i)
      row_of[i] = numbers_of(batch.sites[batch.neighbours[first + i][row]]);
    const Sites q = load_sites(row_of);
    const Vector<V> offset = (q.position - at.position) + (q.shift - at.shift);
    views.at[row] = view_of(offset, at.weight - q.weight, frame);
    sum = sum + q.closeness;
  }
  for (; row < views.rows; ++row) {
    // Without a branch: which point has one neighbour more cannot be foretold.
    for (std::size_t i = 0; i < kStep; ++i)
      row_of[i] =
          numbers_of(batch.sites[batch.neighbours[first + i][row < batch.counts[first + i] ? row : 0]]);
    const Mask is_there = all<V>(static_cast<double>(row)) < all_counts;
    const Sites q = load_sites(row_of);
    const Vector<V> offset = (q.position - at.position) + (q.shift - at.shift);
    views.at[row] = view_of(select(is_there, offset, {all<V>(0), all<V>(0), all<V>(0)}),
                            hn::IfThenElseZero(is_there, at.weight - q.weight), frame);
    sum = sum + hn::IfThenElseZero(is_there, q.closeness);
  }
  views.distance = (all_counts + all<V>(1)) / sum;
}

HWY_INLINE V cross(const View<V>& edge, const View<V>& other) {
  return edge.x * other.y - edge.y * other.x;
}

struct Corner {
  V x, y;
  Count row;
};

// The view farthest from the origin is a corner.
Corner first_corner(const Views& views, V& squared_distance, Count& seen) {
  Corner corner{all<V>(0), all<V>(0), count(0)};
  squared_distance = all<V>(0);
  seen = count(0);
  for (std::size_t row = 0; row < views.rows; ++row) {
    const auto [x, y] = views.at[row];
    const V squared = x * x + y * y;
    const Mask is_farther = squared > squared_distance;
    squared_distance = hn::IfThenElse(is_farther, squared, squared_distance);
    corner.x = hn::IfThenElse(is_farther, x, corner.x);
    corner.y = hn::IfThenElse(is_farther, y, corner.y);
    corner.row = hn::IfThenElse(hn::RebindMask(kWhole, is_farther), count(row), corner.row);
    seen = seen - hn::VecFromMask(kWhole, hn::RebindMask(kWhole, squared == squared));
  }
  return corner;
}

// Rows of some views: how many, and their sum.
constexpr int kCountShift = 32;

// The edge from a corner such that no view is to its right. `back`: the edge before, turned; all views are to
// its right by more than `margin` but those `on_edge`. Views nearer to a line than `rounding` are on it.
HWY_INLINE View<V> next_edge(const Views& views, const Corner& at, const View<V>& back, V margin, V rounding,
                             Count& on_edge) {
  const V least = hn::Neg(margin), right = hn::Neg(rounding);
  const auto first_of = [&](const View<V>& a, const View<V>& b) HWY_ATTR {
    const Mask is_right = cross(a, b) < right;
    return View<V>{hn::IfThenElse(is_right, b.x, a.x), hn::IfThenElse(is_right, b.y, a.y)};
  };
  View<V> next[kChains];
  for (View<V>& edge : next) edge = back;
  on_edge = count(0);
  Count row_of_one = count(std::size_t{1} << kCountShift);
  const auto compare = [&](std::size_t row, View<V>& chain) HWY_ATTR {
    const View<V> edge{views.at[row].x - at.x, views.at[row].y - at.y};
    const auto is_on_edge = hn::RebindMask(kWhole, cross(back, edge) >= least);
    on_edge = hn::IfThenElse(is_on_edge, on_edge + row_of_one, on_edge);
    chain = first_of(chain, edge);
    row_of_one = row_of_one + count(1);
  };
  std::size_t row = 0;
  for (; row + kChains <= views.rows; row += kChains) {
    for (std::size_t i = 0; i < kChains; ++i) compare(row + i, next[i]);
  }
  for (; row < views.rows; row += 2) {
    compare(row, next[0]);
    compare(row + 1, next[1]);
  }
  return first_of(first_of(next[0], next[1]), first_of(next[2], next[3]));
}

// Eight bytes each: a corner's row, and the ball beyond it.
template <class Ball>
HWY_INLINE void store_corners(Count row, Ball ball, LinkVertex<LocalIndex>* corners) {
  const hn::Rebind<std::uint32_t, Doubles> bits;
  std::uint64_t packed[kStep];
  hn::StoreU(hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(kWhole, hn::BitCast(bits, ball))), row), kWhole, packed);
  __builtin_memcpy(corners, packed, sizeof packed);
}

// Gift wrapping: the convex hull from corner to corner, counterclockwise.
void find_stars_from(std::size_t first, const Views& views, BatchStars& stars) {
  V squared_distance;
  Count seen;
  const Corner start = first_corner(views, squared_distance, seen);
  const V scale = all<V>(kOnEdge) * hn::Sqrt(squared_distance),
          rounding = all<V>(kRounding) * squared_distance;

  const auto none = hn::FirstN(kWhole, 0);
  auto is_open = seen > count(2), ambiguous = none;
  Count sizes = count(0), before = start.row;
  Corner at = start;
  View<V> back{start.y, hn::Neg(start.x)};  // all views are on one side of the tangent at the farthest
  V margin = all<V>(0);
  for (std::size_t step = 0;; ++step) {
    Count on_edge;
    const View<V> next = next_edge(views, at, back, margin, rounding, on_edge);
    if (step > 0) {
      // Both ends of the edge before are on it. Any other: the way is not the hull's, or within rounding.
      const auto are_two = hn::ShiftRight<kCountShift>(on_edge) == count(2);
      ambiguous = hn::Or(ambiguous, hn::AndNot(are_two, is_open));
      is_open = hn::AndNot(ambiguous, is_open);
      at.row = hn::And(on_edge, count((std::size_t{1} << kCountShift) - 1)) - before;
      const auto is_closed = hn::And(is_open, at.row == start.row);
      sizes = hn::IfThenElse(is_closed, count(step), sizes);
      is_open = hn::AndNot(is_closed, is_open);
    }
    if (hn::AllFalse(kWhole, is_open)) break;
    if (step == views.rows) {
      ambiguous = hn::Or(ambiguous, is_open);
      break;
    }
    store_corners(at.row, ball_at(at.x, at.y, next.x, next.y, views.distance), &stars.corners[step][first]);
    margin = scale * (hn::Abs(next.x) + hn::Abs(next.y));
    back = {hn::Neg(next.x), hn::Neg(next.y)};
    before = at.row;
    // Where the edges lead, within rounding; the views on the edge show which row that is.
    at.x = at.x + next.x;
    at.y = at.y + next.y;
  }
  std::uint64_t found[kStep];
  hn::StoreU(hn::IfThenElse(ambiguous, count(BatchStars::kAmbiguous), sizes), kWhole, found);
  for (std::size_t lane = 0; lane < kStep; ++lane)
    stars.sizes[first + lane] = static_cast<std::uint32_t>(found[lane]);
}

// ---- Consistency

constexpr std::uint32_t kNone = UINT32_MAX;

// Bit 2 i: corner i of the first kFewCorners is that point.
HWY_INLINE std::uint32_t places_of(LocalIndex point, const LinkVertex<LocalIndex>* star) {
  constexpr hn::CappedTag<std::uint32_t, 2 * kFewCorners> kCorners;
  if constexpr (kLanes<decltype(kCorners)> == 2 * kFewCorners) {  // a point and a ball each
    const auto corners = hn::LoadU(kCorners, reinterpret_cast<const std::uint32_t*>(star));
    return bits_of(kCorners, corners == hn::Set(kCorners, point)) & 0x5555;
  } else {
    std::uint32_t places = 0;
    for (std::uint32_t i = 0; i < kFewCorners; ++i)
      places |= static_cast<std::uint32_t>(star[i].point == point) << 2 * i;
    return places;
  }
}

// The corner of a large star after which b follows a, or a follows b.
std::uint32_t find_in_large(const LinkVertex<LocalIndex>* star, std::uint32_t size, LocalIndex a,
                            LocalIndex b) {
  for (std::uint32_t i = 0; i < size; ++i) {
    const LocalIndex here = star[i].point, next = star[i + 1 < size ? i + 1 : 0].point;
    if ((here == a && next == b) || (here == b && next == a)) return i;
  }
  return kNone;
}

// The corner from which the point's triangle with a and b goes on to the next corner.
HWY_INLINE std::uint32_t find_triangle(const StarTable& stars, LocalIndex point, LocalIndex a, LocalIndex b) {
  const auto [begin, size] = stars.places[point];
  const LinkVertex<LocalIndex>* const star = stars.corners + begin;
  std::uint32_t place = kNone;
  if (size <= kFewCorners) {
    const std::uint32_t all = (1U << 2 * size) - 1;
    const std::uint32_t at_a = places_of(a, star) & all, at_b = places_of(b, star) & all;
    const auto next = [&](std::uint32_t at) HWY_ATTR { return at << 2 | at >> ((2 * size - 2) & 31); };
    const std::uint32_t at = (next(at_a) & at_b) != 0 ? at_a : (next(at_b) & at_a) != 0 ? at_b : 0;
    if (at != 0) place = static_cast<std::uint32_t>(__builtin_ctz(at)) / 2;
  } else {
    place = find_in_large(star, size, a, b);
  }
  return place != kNone && star[place].room <= 0 ? begin + place : kNone;
}

}  // namespace

void find_batch_stars(const StarBatch& batch, BatchStars& stars) {
  std::size_t most = 0;
  for (const std::uint32_t count : batch.counts) most = count > most ? count : most;
  Views views;
  views.rows = (most + 1) / 2 * 2;
  for (std::size_t first = 0; first < kBatchSize; first += kStep) {
    find_views(batch, first, views);
    hn::StoreU(views.distance, Doubles(), stars.distances + first);
    find_stars_from(first, views, stars);
  }
}

void compare_triangles(const StarTable& stars, const AskedTriangle* asked, std::size_t count) {
  for (const AskedTriangle* triangle = asked; triangle < asked + count; ++triangle) {
    const auto [corner, p, a, b] = *triangle;
    const PointState of_a = stars.states[a], of_b = stars.states[b];
    std::uint32_t in_a = corner, in_b = corner;
    if (of_a == PointState::kActive && (in_a = find_triangle(stars, a, p, b)) == kNone) continue;
    if (of_b == PointState::kActive && (in_b = find_triangle(stars, b, p, a)) == kNone) continue;
    const auto is_told_later = [](PointState corner) HWY_ATTR {
      return corner != PointState::kActive && corner != PointState::kInactive;
    };
    const bool is_open = is_told_later(of_a) || is_told_later(of_b);
    const Consistency consistency = is_open ? Consistency::kUndecided : Consistency::kConsistent;
    stars.consistencies[corner] = stars.consistencies[in_a] = stars.consistencies[in_b] = consistency;
  }
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(find_batch_stars);
void find_batch_stars(const StarBatch& batch, BatchStars& stars) {
  HWY_DYNAMIC_DISPATCH(find_batch_stars)(batch, stars);
}

HWY_EXPORT(compare_triangles);
void compare_triangles(const StarTable& stars, const AskedTriangle* asked, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(compare_triangles)(stars, asked, count);
}

}  // namespace lacuna
#endif
