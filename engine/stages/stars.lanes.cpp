#include "engine/stages/star_bundle.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr double kUndefined = __builtin_nan("");

// A corner to the right of an edge by less than this is on it, in units of the edge's length times the
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

// Offset of a neighbour, and the difference of the weights.
using Offset = double __attribute__((vector_size(32)));

Offset load_offset(const double* from) {
  Offset offset;
  __builtin_memcpy(&offset, from, sizeof offset);
  return offset;
}

// Returns the radius of the point's ball. Beyond the point's count the offsets are 0.
double gather(const StarBundle& bundle, std::size_t point, std::size_t rows, Offset (*offsets)[kLanes],
              std::size_t lane) {
  // A seat is eight numbers: position, shift, mean distance, weight. The fourth of what is loaded is not
  // used.
  static_assert(sizeof(Seat) == 8 * sizeof(double));
  const Seat& at = bundle.seats[bundle.points[point]];
  const Offset position = load_offset(at.position), shift = load_offset(at.shift);
  double sum = at.mean_distance;
  const std::size_t count = bundle.counts[point];
  for (std::size_t row = 0; row < count; ++row) {
    const Seat& q = bundle.seats[bundle.neighbours[point][row]];
    Offset offset = (load_offset(q.position) - position) + (load_offset(q.shift) - shift);
    offset[3] = at.weight - q.weight;
    offsets[row][lane] = offset;
    sum += q.mean_distance;
  }
  for (std::size_t row = count; row < rows; ++row) offsets[row][lane] = Offset{};
  return kBall * sum / static_cast<double>(count + 1);
}

void look_around(const StarBundle& bundle, std::size_t first, Views& views) {
  Offset offsets[kMostSeen][kLanes];
  std::size_t most = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    most = bundle.counts[first + lane] > most ? bundle.counts[first + lane] : most;
  views.rows = (most + kChains - 1) / kChains * kChains;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    views.radius[lane] = gather(bundle, first + lane, views.rows, offsets, lane);

  const auto& normals = bundle.normals;
  const Frame<Lanes> frame =
      frame_of(Vector<Lanes>{load(normals[0] + first), load(normals[1] + first), load(normals[2] + first)});
  for (std::size_t row = 0; row < views.rows; ++row) {
    Vector<Lanes> d;
    Lanes weight;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      d.x[lane] = offsets[row][lane][0];
      d.y[lane] = offsets[row][lane][1];
      d.z[lane] = offsets[row][lane][2];
      weight[lane] = offsets[row][lane][3];
    }
    const Lanes power = dot(d, d) + weight;
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
      on_edge -= cross(back, x, y) >= -margin;
      const Edge edge{x, y, {views.x[row], views.y[row], LaneBits{} + static_cast<std::int64_t>(row)}};
      next[i] = choose(cross(next[i], x, y) < 0.0, edge, next[i]);
    }
  }
  for (std::size_t chains = kChains / 2; chains > 0; chains /= 2) {
    for (std::size_t i = 0; i < chains; ++i) {
      const Edge& other = next[i + chains];
      next[i] = choose(cross(next[i], other.x, other.y) < 0.0, other, next[i]);
    }
  }
  return next[0];
}

// Eight bytes each: a corner's row, and the room beyond it.
LACUNA_INLINE LaneBits pack(LaneBits row, Lanes room) {
  using Floats = float __attribute__((vector_size(kLaneBytes / 2)));
  using FloatBits = std::uint32_t __attribute__((vector_size(kLaneBytes / 2)));
  const FloatBits rooms = reinterpret_cast<FloatBits>(__builtin_convertvector(room, Floats));
  return __builtin_convertvector(rooms, LaneBits) << 32 | row;
}

// Gift wrapping: the convex hull from corner to corner, counterclockwise.
void find_part(const StarBundle& bundle, std::size_t first, BundledStars& stars) {
  Views views;
  look_around(bundle, first, views);
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
    __builtin_memcpy(&stars.corners[step][first], &corners, sizeof corners);
    margin = scale * root(next.x * next.x + next.y * next.y);
    back = {-next.x, -next.y, at};
    at = next.to;
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    stars.sizes[first + lane] =
        in_doubt[lane] ? BundledStars::kInDoubt : static_cast<std::uint32_t>(sizes[lane]);
}

}  // namespace

void find_bundled_stars(const StarBundle& bundle, BundledStars& stars) {
  for (std::size_t first = 0; first < kStarBundle; first += kLanes) find_part(bundle, first, stars);
}

}  // namespace lacuna::LACUNA_LANES
