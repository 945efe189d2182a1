// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/boundary/tangential/star_batch.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/boundary/tangential/stars.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/boundary/tangential/star-inl.hpp"
#include "engine/simd/vector-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::tangential::HWY_NAMESPACE {
using namespace lacuna::HWY_NAMESPACE;

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

// A view at most this far from an edge is on it. The unit is the edge's |x| + |y| times the distance of the
// farthest view. That is 500 times the possible rounding error.
constexpr double kOnEdge = 1e-12;

// A hundred times the largest possible rounding error, in units of the square of that distance.
constexpr double kRounding = 1e-13;

// Comparisons of ranks depend on one another. This many at a time are independent.
constexpr std::size_t kChains = 4;

// The views of as many points as a vector holds, by rank.
struct Views {
  View<V> at[kMostNeighbours];
  std::size_t ranks;  // an even number
  V distance;         // `Sampling::distance`
};

// The parts of a site that the stars need.
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

// Finds the views of point `first` and the next ones. A neighbour that a point does not have is at an offset
// of 0.
void find_views(const StarBatch& batch, std::size_t first, Views& views) {
  const double* points[kStep];
  double counts[kStep];
  std::size_t common = views.ranks;
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
  const double* sources[kStep];
  std::size_t rank = 0;
  for (; rank < common; ++rank) {
    for (std::size_t i = 0; i < kStep; ++i)
      sources[i] = numbers_of(batch.sites[batch.neighbours[first + i][rank]]);
    const Sites q = load_sites(sources);
    const Vector<V> offset = (q.position - at.position) + (q.shift - at.shift);
    views.at[rank] = view_of(offset, at.weight - q.weight, frame);
    sum = sum + q.closeness;
  }
  for (; rank < views.ranks; ++rank) {
    // Without a branch: which point has one neighbour more is not predictable.
    for (std::size_t i = 0; i < kStep; ++i)
      sources[i] =
          numbers_of(batch.sites[batch.neighbours[first + i][rank < batch.counts[first + i] ? rank : 0]]);
    const Mask is_there = all<V>(static_cast<double>(rank)) < all_counts;
    const Sites q = load_sites(sources);
    const Vector<V> offset = (q.position - at.position) + (q.shift - at.shift);
    views.at[rank] = view_of(select(is_there, offset, {all<V>(0), all<V>(0), all<V>(0)}),
                             hn::IfThenElseZero(is_there, at.weight - q.weight), frame);
    sum = sum + hn::IfThenElseZero(is_there, q.closeness);
  }
  views.distance = (all_counts + all<V>(1)) / sum;
}

HWY_INLINE V cross(const View<V>& edge, const View<V>& other) {
  return edge.x * other.y - edge.y * other.x;
}

struct HullVertex {
  V x, y;
  Count rank;
};

// The view farthest from the origin is a vertex.
HullVertex first_vertex(const Views& views, V& squared_distance, Count& defined) {
  HullVertex vertex{all<V>(0), all<V>(0), count(0)};
  squared_distance = all<V>(0);
  defined = count(0);
  for (std::size_t rank = 0; rank < views.ranks; ++rank) {
    const auto [x, y] = views.at[rank];
    const V squared = x * x + y * y;
    const Mask is_farther = squared > squared_distance;
    squared_distance = hn::IfThenElse(is_farther, squared, squared_distance);
    vertex.x = hn::IfThenElse(is_farther, x, vertex.x);
    vertex.y = hn::IfThenElse(is_farther, y, vertex.y);
    vertex.rank = hn::IfThenElse(hn::RebindMask(kWhole, is_farther), count(rank), vertex.rank);
    defined = defined - hn::VecFromMask(kWhole, hn::RebindMask(kWhole, squared == squared));
  }
  return vertex;
}

// Ranks of some views: how many, and their sum.
constexpr int kCountShift = 32;

// Finds the edge from a vertex such that no view is to its right. `back`: the edge before, turned. All views
// except those `on_edge` are to its right by more than `margin`. Views nearer to a line than `rounding` are
// on it.
HWY_INLINE View<V> next_edge(const Views& views, const HullVertex& at, const View<V>& back, V margin,
                             V rounding, Count& on_edge) {
  const V least = hn::Neg(margin), right = hn::Neg(rounding);
  const auto first_of = [&](const View<V>& a, const View<V>& b) HWY_ATTR {
    const Mask is_right = cross(a, b) < right;
    return View<V>{hn::IfThenElse(is_right, b.x, a.x), hn::IfThenElse(is_right, b.y, a.y)};
  };
  View<V> next[kChains];
  for (View<V>& edge : next) edge = back;
  on_edge = count(0);
  Count rank_of_one = count(std::size_t{1} << kCountShift);
  const auto compare = [&](std::size_t rank, View<V>& chain) HWY_ATTR {
    const View<V> edge{views.at[rank].x - at.x, views.at[rank].y - at.y};
    const auto is_on_edge = hn::RebindMask(kWhole, cross(back, edge) >= least);
    on_edge = hn::IfThenElse(is_on_edge, on_edge + rank_of_one, on_edge);
    chain = first_of(chain, edge);
    rank_of_one = rank_of_one + count(1);
  };
  std::size_t rank = 0;
  for (; rank + kChains <= views.ranks; rank += kChains) {
    for (std::size_t i = 0; i < kChains; ++i) compare(rank + i, next[i]);
  }
  for (; rank < views.ranks; rank += 2) {
    compare(rank, next[0]);
    compare(rank + 1, next[1]);
  }
  return first_of(first_of(next[0], next[1]), first_of(next[2], next[3]));
}

// Eight bytes each: a vertex's number among the neighbours, and the circumradius beyond it.
template <class Radius>
HWY_INLINE void store_vertices(Count rank, Radius radius, LinkVertex<LocalIndex>* link) {
  const hn::Rebind<std::uint32_t, Doubles> bits;
  std::uint64_t packed[kStep];
  hn::StoreU(hn::Or(hn::ShiftLeft<32>(hn::PromoteTo(kWhole, hn::BitCast(bits, radius))), rank), kWhole,
             packed);
  __builtin_memcpy(link, packed, sizeof packed);
}

// Gift wrapping: the convex hull from vertex to vertex, counterclockwise. A chain of sorted views would take
// fewer comparisons, but every lane would sort and go back in its own way. Here all lanes take the same
// steps: each vertex costs one pass over the views. `on_edge` counts the views on the edge before, and adds
// up their ranks. So the rank of its end is known without a search, and where there are not two, the star is
// left to `find_star_exactly`.
void find_stars_from(std::size_t first, const Views& views, BatchStars& stars) {
  V squared_distance;
  Count defined;
  const HullVertex start = first_vertex(views, squared_distance, defined);
  const V scale = all<V>(kOnEdge) * hn::Sqrt(squared_distance),
          rounding = all<V>(kRounding) * squared_distance;

  const auto none = hn::FirstN(kWhole, 0);
  auto is_open = defined > count(2), ambiguous = none;
  Count sizes = count(0), before = start.rank;
  HullVertex at = start;
  View<V> back{start.y, hn::Neg(start.x)};  // all views are on one side of the tangent at the farthest
  V margin = all<V>(0);
  for (std::size_t step = 0;; ++step) {
    Count on_edge;
    const View<V> next = next_edge(views, at, back, margin, rounding, on_edge);
    if (step > 0) {
      // Both ends of the edge before are on it. Any other view on it is not on the hull's way, or lies within
      // rounding.
      const auto are_two = hn::ShiftRight<kCountShift>(on_edge) == count(2);
      ambiguous = hn::Or(ambiguous, hn::AndNot(are_two, is_open));
      is_open = hn::AndNot(ambiguous, is_open);
      at.rank = hn::And(on_edge, count((std::size_t{1} << kCountShift) - 1)) - before;
      const auto is_closed = hn::And(is_open, at.rank == start.rank);
      sizes = hn::IfThenElse(is_closed, count(step), sizes);
      is_open = hn::AndNot(is_closed, is_open);
    }
    if (hn::AllFalse(kWhole, is_open)) break;
    if (step == views.ranks) {
      ambiguous = hn::Or(ambiguous, is_open);
      break;
    }
    store_vertices(at.rank, radius_at(at.x, at.y, next.x, next.y, views.distance), &stars.links[step][first]);
    margin = scale * (hn::Abs(next.x) + hn::Abs(next.y));
    back = {hn::Neg(next.x), hn::Neg(next.y)};
    before = at.rank;
    // Moves to the end of the edge, within rounding. The views on the edge show which rank that is.
    at.x = at.x + next.x;
    at.y = at.y + next.y;
  }
  std::uint64_t found[kStep];
  hn::StoreU(hn::IfThenElse(ambiguous, count(BatchStars::kAmbiguous), sizes), kWhole, found);
  for (std::size_t lane = 0; lane < kStep; ++lane)
    stars.sizes[first + lane] = static_cast<std::uint32_t>(found[lane]);
}

}  // namespace

void find_batch_stars(const StarBatch& batch, BatchStars& stars) {
  std::size_t most = 0;
  for (const std::uint32_t count : batch.counts) most = count > most ? count : most;
  Views views;
  views.ranks = (most + 1) / 2 * 2;
  for (std::size_t first = 0; first < kBatchSize; first += kStep) {
    find_views(batch, first, views);
    hn::StoreU(views.distance, Doubles(), stars.distances + first);
    find_stars_from(first, views, stars);
  }
}

}  // namespace lacuna::tangential::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna::tangential {

HWY_EXPORT(find_batch_stars);
void find_batch_stars(const StarBatch& batch, BatchStars& stars) {
  HWY_DYNAMIC_DISPATCH(find_batch_stars)(batch, stars);
}

}  // namespace lacuna::tangential
#endif
