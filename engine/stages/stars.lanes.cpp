#include "engine/core/four.hpp"
#include "engine/stages/star_bundle.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr double kUndefined = __builtin_nan("");

// A view beside an edge by no more than this is on it, in units of the edge's |x| + |y| times the distance of
// the farthest view: 500 times what rounding can do.
constexpr double kOnEdge = 1e-12;

// What rounding can do at most, by a hundred times, in units of the square of that distance.
constexpr double kRounding = 1e-13;

// Comparisons of rows depend on one another: as many at a time do not.
constexpr std::size_t kChains = 4;

// Where points see their neighbours, inverted, by row. NaN: not at all.
struct Views {
  struct Row {
    Lanes x, y;
  } at[kMostSeen];
  std::size_t rows;  // an even number
  Lanes distance;    // `Sampling::distance`
};

// Offsets of neighbours and differences of weights.
struct alignas(64) Offsets {
  double x[kStarBundle], y[kStarBundle], z[kStarBundle], weight[kStarBundle];
};

LACUNA_INLINE void store_turned(const Four (&points)[kFour], Offsets& offsets, std::size_t first) {
  const Turned turned = turn(points);
  store(&offsets.x[first], turned.x);
  store(&offsets.y[first], turned.y);
  store(&offsets.z[first], turned.z);
  store(&offsets.weight[first], turned.w);
}

// What is loaded of a seat: its eight numbers are position, shift, closeness and weight.
struct LoadedSeat {
  Four position;  // and the shift's x
  Four shift;     // and the closeness
  Four weight;    // the last; before it what the others have
};
static_assert(sizeof(Seat) == 8 * sizeof(double));

LACUNA_INLINE LoadedSeat load_seat(const Seat& seat) {
  return {load_as<Four>(seat.position), load_as<Four>(seat.shift), load_as<Four>(seat.shift + 1)};
}

// Offsets of neighbours of kFour points from `first` on, 0 where there are no more, and
// `Sampling::distance`.
void gather(const StarBundle& bundle, std::size_t first, std::size_t rows, Offsets* offsets,
            double* distances) {
  LoadedSeat at[kFour];
  Four sums[kFour];
  std::size_t common = rows;
  for (std::size_t i = 0; i < kFour; ++i) {
    at[i] = load_seat(bundle.seats[bundle.points[first + i]]);
    sums[i] = at[i].shift;
    common = bundle.counts[first + i] < common ? bundle.counts[first + i] : common;
  }
  Four around[kFour];
  const auto look_at_neighbour = [&](std::size_t i, std::size_t row, FourBits is_there) {
    const LoadedSeat q = load_seat(bundle.seats[bundle.neighbours[first + i][row]]);
    const Four offset = (q.position - at[i].position) + (q.shift - at[i].shift);
    const Four with_weight = __builtin_shufflevector(offset, at[i].weight - q.weight, 0, 1, 2, 7);
    const auto masked = [&](Four four) {
      return reinterpret_cast<Four>(reinterpret_cast<FourBits>(four) & is_there);
    };
    around[i] = masked(with_weight);
    sums[i] += masked(q.shift);
  };
  std::size_t row = 0;
  for (; row < common; ++row) {
    for (std::size_t i = 0; i < kFour; ++i) look_at_neighbour(i, row, ~FourBits{});
    store_turned(around, offsets[row], first);
  }
  for (; row < rows; ++row) {
    for (std::size_t i = 0; i < kFour; ++i) {
      const std::size_t count = bundle.counts[first + i];
      const FourBits is_there = FourBits{} - static_cast<std::int64_t>(row < count);
      // Without a branch: which point has one neighbour more cannot be foretold.
      look_at_neighbour(i, row < count ? row : 0, is_there);
    }
    store_turned(around, offsets[row], first);
  }
  for (std::size_t i = 0; i < kFour; ++i)
    distances[first + i] = static_cast<double>(bundle.counts[first + i] + 1) / sums[i][3];
}

void look_around(const StarBundle& bundle, const Offsets* offsets, std::size_t first, Views& views) {
  const auto& normals = bundle.normals;
  const Frame<Lanes> frame =
      frame_of(Vector<Lanes>{load(normals[0] + first), load(normals[1] + first), load(normals[2] + first)});
  for (std::size_t row = 0; row < views.rows; ++row) {
    const Vector<Lanes> d{load(offsets[row].x + first), load(offsets[row].y + first),
                          load(offsets[row].z + first)};
    const Lanes power = dot(d, d) + load(offsets[row].weight + first);
    const Lanes inverse = select(power > 0.0, 1.0 / power, all_lanes(kUndefined));
    views.at[row].x = dot(d, frame.u) * inverse;
    views.at[row].y = dot(d, frame.v) * inverse;
  }
}

// From a corner to the next one.
struct Edge {
  Lanes x, y;
};

LACUNA_INLINE Lanes cross(const Edge& edge, const Edge& other) {
  return edge.x * other.y - edge.y * other.x;
}

struct Corner {
  Lanes x, y;
  LaneBits row;
};

// The view farthest from the origin is a corner.
Corner first_corner(const Views& views, Lanes& squared_distance, LaneBits& seen) {
  Corner corner{};
  squared_distance = Lanes{};
  seen = LaneBits{};
  LaneBits number{};
  for (std::size_t row = 0; row < views.rows; ++row, ++number) {
    const Lanes x = views.at[row].x, y = views.at[row].y;
    const Lanes squared = x * x + y * y;
    const LaneBits is_farther = squared > squared_distance;
    squared_distance = select(is_farther, squared, squared_distance);
    corner.x = select(is_farther, x, corner.x);
    corner.y = select(is_farther, y, corner.y);
    corner.row = is_farther ? number : corner.row;
    seen = squared == squared ? seen + 1 : seen;
  }
  return corner;
}

// Rows of some views: how many, and their sum.
constexpr int kCountShift = 32;

// The edge from a corner such that no view is to its right. `back`: the edge before, turned; all views are to
// its right by more than `margin` but those `on_edge`. Views nearer to a line than `rounding` are on it.
LACUNA_INLINE Edge next_edge(const Views& views, const Corner& at, const Edge& back, Lanes margin,
                             Lanes rounding, LaneBits& on_edge) {
  const auto first_of = [&](const Edge& a, const Edge& b) {
    const LaneBits is_right = cross(a, b) < -rounding;
    return Edge{select(is_right, b.x, a.x), select(is_right, b.y, a.y)};
  };
  Edge next[kChains];
  for (Edge& edge : next) edge = back;
  on_edge = LaneBits{};
  LaneBits row_of_one = LaneBits{} + (std::int64_t{1} << kCountShift);
  const auto look_at = [&](std::size_t row, Edge& chain) {
    const Edge edge{views.at[row].x - at.x, views.at[row].y - at.y};
    on_edge = cross(back, edge) >= -margin ? on_edge + row_of_one : on_edge;
    chain = first_of(chain, edge);
    ++row_of_one;
  };
  std::size_t row = 0;
  for (; row + kChains <= views.rows; row += kChains) {
    for (std::size_t i = 0; i < kChains; ++i) look_at(row + i, next[i]);
  }
  for (; row < views.rows; row += 2) {
    look_at(row, next[0]);
    look_at(row + 1, next[1]);
  }
  return first_of(first_of(next[0], next[1]), first_of(next[2], next[3]));
}

// Eight bytes each: a corner's row, and the ball beyond it.
LACUNA_INLINE LaneBits pack(LaneBits row, SingleLanes ball) {
  using SingleBits = std::uint32_t __attribute__((vector_size(sizeof(SingleLanes))));
  return __builtin_convertvector(reinterpret_cast<SingleBits>(ball), LaneBits) << 32 | row;
}

// Gift wrapping: the convex hull from corner to corner, counterclockwise.
void find_part(const Views& views, std::size_t first, BundledStars& stars) {
  Lanes squared_distance;
  LaneBits seen;
  const Corner start = first_corner(views, squared_distance, seen);
  const Lanes scale = kOnEdge * root(squared_distance), rounding = kRounding * squared_distance;

  LaneBits is_open = seen > 2, in_doubt{}, sizes{}, before = start.row;
  Corner at = start;
  Edge back{start.y, -start.x};  // all views are on one side of the tangent at the farthest
  Lanes margin{};
  for (std::size_t step = 0;; ++step) {
    LaneBits on_edge;
    const Edge next = next_edge(views, at, back, margin, rounding, on_edge);
    if (step > 0) {
      // Both ends of the edge before are on it. Any other: the way is not the hull's, or within rounding.
      in_doubt |= is_open & (on_edge >> kCountShift != 2);
      is_open &= ~in_doubt;
      at.row = (on_edge & ((std::int64_t{1} << kCountShift) - 1)) - before;
      const LaneBits is_closed = is_open & (at.row == start.row);
      sizes = is_closed ? LaneBits{} + static_cast<std::int64_t>(step) : sizes;
      is_open &= ~is_closed;
    }
    if (!any(is_open)) break;
    if (step == views.rows) {
      in_doubt |= is_open;
      break;
    }
    const LaneBits corners = pack(at.row, ball_at(at.x, at.y, next.x, next.y, views.distance));
    __builtin_memcpy(&stars.corners[step][first], &corners, sizeof corners);
    margin = scale * (magnitude(next.x) + magnitude(next.y));
    back = {-next.x, -next.y};
    before = at.row;
    // Where the edges lead, within rounding; which row that is, the views on the edge will tell.
    at.x += next.x;
    at.y += next.y;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    stars.sizes[first + lane] =
        in_doubt[lane] ? BundledStars::kInDoubt : static_cast<std::uint32_t>(sizes[lane]);
}

// ---- Agreement

constexpr std::uint32_t kNone = UINT32_MAX;

// Bit 2 i: corner i of the first kFewCorners is that point.
LACUNA_INLINE std::uint32_t places_of(LocalIndex point, const StarCorner<LocalIndex>* star) {
#if defined(__AVX512F__)
  const __m512i point_in_all = _mm512_set1_epi32(static_cast<int>(point));
  return _mm512_mask_cmpeq_epi32_mask(0x5555, _mm512_loadu_si512(star), point_in_all);
#else
  std::uint32_t places = 0;
  for (std::uint32_t i = 0; i < kFewCorners; ++i)
    places |= static_cast<std::uint32_t>(star[i].point == point) << 2 * i;
  return places;
#endif
}

// The corner of a large star after which b follows a, or a follows b.
std::uint32_t find_in_large(const StarCorner<LocalIndex>* star, std::uint32_t size, LocalIndex a,
                            LocalIndex b) {
  for (std::uint32_t i = 0; i < size; ++i) {
    const LocalIndex here = star[i].point, next = star[i + 1 < size ? i + 1 : 0].point;
    if ((here == a && next == b) || (here == b && next == a)) return i;
  }
  return kNone;
}

// The corner from which the point's triangle with a and b goes on to the next corner.
LACUNA_INLINE std::uint32_t find_triangle(const StarTable& stars, LocalIndex point, LocalIndex a,
                                          LocalIndex b) {
  const auto [begin, size] = stars.places[point];
  const StarCorner<LocalIndex>* const star = stars.corners + begin;
  std::uint32_t place = kNone;
  if (size <= kFewCorners) {
    const std::uint32_t all = (1U << 2 * size) - 1;
    const std::uint32_t at_a = places_of(a, star) & all, at_b = places_of(b, star) & all;
    const auto next = [&](std::uint32_t at) { return at << 2 | at >> ((2 * size - 2) & 31); };
    const std::uint32_t at = (next(at_a) & at_b) != 0 ? at_a : (next(at_b) & at_a) != 0 ? at_b : 0;
    if (at != 0) place = static_cast<std::uint32_t>(__builtin_ctz(at)) / 2;
  } else {
    place = find_in_large(star, size, a, b);
  }
  return place != kNone && star[place].room <= 0 ? begin + place : kNone;
}

}  // namespace

void find_bundled_stars(const StarBundle& bundle, BundledStars& stars) {
  std::size_t most = 0;
  for (const std::uint32_t count : bundle.counts) most = count > most ? count : most;
  Views views;
  views.rows = (most + 1) / 2 * 2;
  Offsets offsets[kMostSeen];
  for (std::size_t first = 0; first < kStarBundle; first += kFour)
    gather(bundle, first, views.rows, offsets, stars.distances);
  for (std::size_t first = 0; first < kStarBundle; first += kLanes) {
    look_around(bundle, offsets, first, views);
    views.distance = load(stars.distances + first);
    find_part(views, first, stars);
  }
}

void agree_on_triangles(const StarTable& stars, const AskedTriangle* asked, std::size_t count) {
  for (const AskedTriangle* triangle = asked; triangle < asked + count; ++triangle) {
    const auto [corner, p, a, b] = *triangle;
    const Standing of_a = stars.standings[a], of_b = stars.standings[b];
    std::uint32_t in_a = corner, in_b = corner;
    if (of_a == Standing::kRough && (in_a = find_triangle(stars, a, p, b)) == kNone) continue;
    if (of_b == Standing::kRough && (in_b = find_triangle(stars, b, p, a)) == kNone) continue;
    const auto is_told_later = [](Standing corner) {
      return corner != Standing::kRough && corner != Standing::kInner;
    };
    const bool is_open = is_told_later(of_a) || is_told_later(of_b);
    const Agreement agreement = is_open ? Agreement::kOpen : Agreement::kAgreed;
    stars.agreements[corner] = stars.agreements[in_a] = stars.agreements[in_b] = agreement;
  }
}

}  // namespace lacuna::LACUNA_LANES
