#include "engine/stages/star_bundle.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr double kUndefined = __builtin_nan("");

// A corner to the right of an edge by less than this is on it, in units of the edge's |x| + |y| times the
// distance of the farthest corner: 500 times what rounding can do.
constexpr double kOnEdge = 1e-12;

// Comparisons of rows depend on one another: as many at a time do not.
constexpr std::size_t kChains = 4;
static_assert(kMostSeen % kChains == 0);

// Where points see their neighbours, inverted, by row. NaN: not at all.
struct Views {
  Lanes x[kMostSeen], y[kMostSeen];
  std::size_t rows;  // a multiple of kChains
  Lanes radius;      // of the ball
};

// Points whose neighbours are read side by side.
constexpr std::size_t kAbreast = 4;
using Four = double __attribute__((vector_size(kAbreast * sizeof(double))));
using FourBits = std::int64_t __attribute__((vector_size(sizeof(Four))));

LACUNA_INLINE Four load_four(const double* from) {
  Four four;
  __builtin_memcpy(&four, from, sizeof four);
  return four;
}

// Offsets of neighbours and differences of weights, by row.
struct Offsets {
  alignas(64) double x[kMostSeen][kStarBundle], y[kMostSeen][kStarBundle], z[kMostSeen][kStarBundle];
  double weight[kMostSeen][kStarBundle];
};

LACUNA_INLINE void store_transposed(const Four (&points)[kAbreast], Offsets& offsets, std::size_t row,
                                    std::size_t first) {
  const FourBits low{0, 4, 2, 6}, high{1, 5, 3, 7}, left{0, 1, 4, 5}, right{2, 3, 6, 7};
  const Four xz01 = __builtin_shuffle(points[0], points[1], low);
  const Four yw01 = __builtin_shuffle(points[0], points[1], high);
  const Four xz23 = __builtin_shuffle(points[2], points[3], low);
  const Four yw23 = __builtin_shuffle(points[2], points[3], high);
  const auto store_four = [&](double* to, Four four) { __builtin_memcpy(to, &four, sizeof four); };
  store_four(&offsets.x[row][first], __builtin_shuffle(xz01, xz23, left));
  store_four(&offsets.y[row][first], __builtin_shuffle(yw01, yw23, left));
  store_four(&offsets.z[row][first], __builtin_shuffle(xz01, xz23, right));
  store_four(&offsets.weight[row][first], __builtin_shuffle(yw01, yw23, right));
}

// Of kAbreast points from `first` on. Beyond a point's count it stands for its neighbours: all is 0.
void gather(const StarBundle& bundle, std::size_t first, std::size_t rows, Offsets& offsets, double* radii) {
  // A seat is eight numbers: position, shift, mean distance, weight. Of four loaded, three are used.
  static_assert(sizeof(Seat) == 8 * sizeof(double));
  const Seat* at[kAbreast];
  Four position[kAbreast], shift[kAbreast];
  double sums[kAbreast];
  for (std::size_t i = 0; i < kAbreast; ++i) {
    at[i] = &bundle.seats[bundle.points[first + i]];
    position[i] = load_four(at[i]->position);
    shift[i] = load_four(at[i]->shift);
    sums[i] = at[i]->mean_distance;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    Four around[kAbreast];
    for (std::size_t i = 0; i < kAbreast; ++i) {
      const bool is_there = row < bundle.counts[first + i];
      const Seat& q = is_there ? bundle.seats[bundle.neighbours[first + i][row]] : *at[i];
      around[i] = (load_four(q.position) - position[i]) + (load_four(q.shift) - shift[i]);
      around[i][3] = at[i]->weight - q.weight;
      sums[i] += is_there ? q.mean_distance : 0.0;
    }
    store_transposed(around, offsets, row, first);
  }
  for (std::size_t i = 0; i < kAbreast; ++i)
    radii[first + i] = kBall * sums[i] / static_cast<double>(bundle.counts[first + i] + 1);
}

void look_around(const StarBundle& bundle, const Offsets& offsets, std::size_t first, Views& views) {
  const auto& normals = bundle.normals;
  const Frame<Lanes> frame =
      frame_of(Vector<Lanes>{load(normals[0] + first), load(normals[1] + first), load(normals[2] + first)});
  for (std::size_t row = 0; row < views.rows; ++row) {
    const Vector<Lanes> d{load(offsets.x[row] + first), load(offsets.y[row] + first),
                          load(offsets.z[row] + first)};
    const Lanes power = dot(d, d) + load(offsets.weight[row] + first);
    const Lanes inverse = select(power > 0.0, 1.0 / power, all_lanes(kUndefined));
    views.x[row] = dot(d, frame.u) * inverse;
    views.y[row] = dot(d, frame.v) * inverse;
  }
}

// A corner of each star.
struct Corner {
  Lanes x, y;
  LaneBits row;
};

// From a corner to another one.
struct Edge {
  Lanes x, y;
  Corner to;
};

LACUNA_INLINE Lanes cross(const Edge& edge, Lanes x, Lanes y) {
  return edge.x * y - edge.y * x;
}
LACUNA_INLINE Edge choose(LaneBits mask, const Edge& a, const Edge& b) {
  return {select(mask, a.x, b.x),
          select(mask, a.y, b.y),
          {select(mask, a.to.x, b.to.x), select(mask, a.to.y, b.to.y), mask ? a.to.row : b.to.row}};
}

// The view farthest from the origin is a corner.
Corner first_corner(const Views& views, Lanes& squared_distance, LaneBits& seen) {
  Corner corner{};
  squared_distance = Lanes{};
  seen = LaneBits{};
  for (std::size_t row = 0; row < views.rows; ++row) {
    const Lanes x = views.x[row], y = views.y[row];
    const Lanes squared = x * x + y * y;
    const LaneBits is_farther = squared > squared_distance;
    squared_distance = select(is_farther, squared, squared_distance);
    corner.x = select(is_farther, x, corner.x);
    corner.y = select(is_farther, y, corner.y);
    corner.row = is_farther ? LaneBits{} + static_cast<std::int64_t>(row) : corner.row;
    seen -= squared == squared;
  }
  return corner;
}

// The edge from a corner such that no view is to its right. `back`: the edge before, turned; all views are to
// its right. `on_edge`: how many are not, by more than `margin`.
LACUNA_INLINE Edge next_edge(const Views& views, const Corner& at, const Edge& back, Lanes margin,
                             LaneBits& on_edge) {
  Edge next[kChains];
  for (Edge& edge : next) edge = back;
  on_edge = LaneBits{};
  for (std::size_t first = 0; first < views.rows; first += kChains) {
    for (std::size_t i = 0; i < kChains; ++i) {
      const std::size_t row = first + i;
      const Lanes x = views.x[row] - at.x, y = views.y[row] - at.y;
      on_edge = cross(back, x, y) >= -margin ? on_edge + 1 : on_edge;
      const Edge edge{x, y, {views.x[row], views.y[row], LaneBits{} + static_cast<std::int64_t>(row)}};
      next[i] = choose(cross(next[i], x, y) < 0.0, edge, next[i]);
    }
  }
  const auto first_of = [](const Edge& a, const Edge& b) { return choose(cross(a, b.x, b.y) < 0.0, b, a); };
  return first_of(first_of(next[0], next[1]), first_of(next[2], next[3]));
}

// Eight bytes each: a corner's row, and the room beyond it.
LACUNA_INLINE LaneBits pack(LaneBits row, Lanes room) {
  using Floats = float __attribute__((vector_size(kLaneBytes / 2)));
  using FloatBits = std::uint32_t __attribute__((vector_size(kLaneBytes / 2)));
  const FloatBits rooms = reinterpret_cast<FloatBits>(__builtin_convertvector(room, Floats));
  return __builtin_convertvector(rooms, LaneBits) << 32 | row;
}

// Gift wrapping: the convex hull from corner to corner, counterclockwise.
void find_part(const Views& views, std::size_t first, BundledStars& stars) {
  Lanes squared_distance;
  LaneBits seen;
  const Corner start = first_corner(views, squared_distance, seen);
  const Lanes scale = kOnEdge * root(squared_distance);

  LaneBits is_open = seen > 2, in_doubt{}, sizes{};
  Corner at = start;
  Edge back{start.y, -start.x, start};  // all views are on one side of the tangent at the farthest
  Lanes margin{};
  for (std::size_t step = 0;; ++step) {
    LaneBits on_edge;
    const Edge next = next_edge(views, at, back, margin, on_edge);
    if (step > 0) {
      // Both ends of the edge before are on it. Any other: the way is not the hull's, or within rounding.
      in_doubt |= is_open & (on_edge != 2);
      is_open &= ~in_doubt;
      const LaneBits is_closed = is_open & (at.row == start.row);
      sizes = is_closed ? LaneBits{} + static_cast<std::int64_t>(step) : sizes;
      is_open &= ~is_closed;
    }
    if (!any(is_open)) break;
    if (step == views.rows) {
      in_doubt |= is_open;
      break;
    }
    const LaneBits corners = pack(at.row, room_at(at.x, at.y, next.x, next.y, views.radius));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::int64_t corner = corners[lane];
      __builtin_memcpy(&stars.corners[first + lane][step], &corner, sizeof corner);
    }
    margin = scale * (magnitude(next.x) + magnitude(next.y));
    back = {-next.x, -next.y, at};
    at = next.to;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    stars.sizes[first + lane] =
        in_doubt[lane] ? BundledStars::kInDoubt : static_cast<std::uint32_t>(sizes[lane]);
}

}  // namespace

void find_bundled_stars(const StarBundle& bundle, BundledStars& stars) {
  std::size_t most = 0;
  for (const std::uint32_t count : bundle.counts) most = count > most ? count : most;
  Views views;
  views.rows = (most + kChains - 1) / kChains * kChains;
  Offsets offsets;
  alignas(64) double radii[kStarBundle];
  for (std::size_t first = 0; first < kStarBundle; first += kAbreast)
    gather(bundle, first, views.rows, offsets, radii);
  for (std::size_t first = 0; first < kStarBundle; first += kLanes) {
    look_around(bundle, offsets, first, views);
    views.radius = load(radii + first);
    find_part(views, first, stars);
  }
}

}  // namespace lacuna::LACUNA_LANES
