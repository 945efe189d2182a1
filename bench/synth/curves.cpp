// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace lacuna::synth {

// ---- The curves of one patch

namespace {

constexpr int kHalvings = 8;

struct Node {
  std::int32_t column, row;
};

// The edge from a node to the next one of its row, or of its column.
using EdgeKey = std::uint64_t;

EdgeKey key_of(const Lattice& lattice, Node first, bool upward) {
  const auto column = static_cast<std::uint64_t>(first.column + 1),
             row = static_cast<std::uint64_t>(first.row + 1);
  return 2 * (row * (static_cast<std::uint64_t>(lattice.columns) + 1) + column) + (upward ? 1 : 0);
}

// The place where the curve crosses an edge, and the crossings before and after it.
struct Crossing {
  Node first;
  bool upward;
  std::array<EdgeKey, 2> beside{};
  int degree = 0;
  bool passed = false;
};

class Tracer {
 public:
  Tracer(const Lattice& lattice, const Visibility& visibility) : lattice_(lattice), visibility_(visibility) {}

  std::vector<Curve> curves() {
    for (std::int32_t row = -1; row < lattice_.rows; ++row)
      for (std::int32_t column = -1; column < lattice_.columns; ++column) cross_square({column, row});
    std::vector<Curve> all;
    for (const EdgeKey key : order_)
      if (!crossings_.at(key).passed) all.push_back(follow(key));
    return all;
  }

 private:
  bool is_sampled(Node node) const { return lattice_.is_sampled(node.column, node.row); }

  // If only opposite corners are sampled, they belong together.
  void cross_square(Node low) {
    const Node right{low.column + 1, low.row}, up{low.column, low.row + 1}, far{low.column + 1, low.row + 1};
    const bool a = is_sampled(low), b = is_sampled(right), c = is_sampled(far), d = is_sampled(up);
    if (a == b && b == c && c == d) return;
    const bool bottom = a != b, top = d != c, left = a != d, side = b != c;
    if (bottom && top && left && side) {
      const bool around_right = a;  // and around up
      link(low, false, around_right ? right : low, true);
      link(up, false, around_right ? low : right, true);
      return;
    }
    std::array<std::pair<Node, bool>, 4> crossed;
    std::size_t count = 0;
    if (bottom) crossed[count++] = {low, false};
    if (side) crossed[count++] = {right, true};
    if (top) crossed[count++] = {up, false};
    if (left) crossed[count++] = {low, true};
    link(crossed[0].first, crossed[0].second, crossed[1].first, crossed[1].second);
  }

  void link(Node a, bool a_upward, Node b, bool b_upward) {
    const EdgeKey one = key_of(lattice_, a, a_upward), other = key_of(lattice_, b, b_upward);
    add(one, a, a_upward, other);
    add(other, b, b_upward, one);
  }

  void add(EdgeKey key, Node first, bool upward, EdgeKey beside) {
    const auto [found, is_new] = crossings_.try_emplace(key, Crossing{first, upward});
    if (is_new) order_.push_back(key);
    Crossing& crossing = found->second;
    crossing.beside[static_cast<std::size_t>(crossing.degree++)] = beside;
  }

  Curve follow(EdgeKey start) {
    Curve curve;
    EdgeKey at = start;
    do {
      Crossing& crossing = crossings_.at(at);
      crossing.passed = true;
      curve.push_back(locate(crossing));
      at = crossings_.at(crossing.beside[0]).passed ? crossing.beside[1] : crossing.beside[0];
    } while (!crossings_.at(at).passed);
    return curve;
  }

  CurveNode locate(const Crossing& crossing) const {
    Node in = crossing.first;
    Node out{in.column + (crossing.upward ? 0 : 1), in.row + (crossing.upward ? 1 : 0)};
    if (!is_sampled(in)) std::swap(in, out);
    const ScenePoint inside = lattice_.at(in.column, in.row);
    const double spacing = double{lattice_.spacing[lattice_.node(in.column, in.row)]};
    CurveNode place{.position = inside.position,
                    .normal = visibility_.facing(inside).value_or(inside.normal),
                    .spacing = spacing,
                    .shape = lattice_.patch.shape,
                    .cause = {Cause::kEdge, lattice_.patch.shape},
                    .at_end = !lattice_.inside(out.column, out.row)};
    if (place.at_end) return place;
    double from = 0, to = 1;
    const auto at = [&](double share) {
      return lattice_.at(in.column + share * (out.column - in.column), in.row + share * (out.row - in.row));
    };
    if (!visibility_.any(inside)) {  // in a gap that was closed
      place.position = at(0.5).position;
      place.cause = {};
      return place;
    }
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (from + to);
      (visibility_.any(at(middle)) ? from : to) = middle;
    }
    place.position = at(from).position;
    for (const std::uint32_t sweep : visibility_.sweeps()) {
      if (visibility_.cause(at(from), sweep).kind != Cause::kNone) continue;
      place.cause = visibility_.cause(at(to), sweep);
      break;
    }
    return place;
  }

  const Lattice& lattice_;
  const Visibility& visibility_;
  std::unordered_map<EdgeKey, Crossing> crossings_;
  std::vector<EdgeKey> order_;  // as they were found
};

// Every curve is closed, because nothing outside of the patch is sampled.
std::vector<Curve> patch_curves(const Lattice& lattice, const Visibility& visibility) {
  return Tracer(lattice, visibility).curves();
}

// ---- Where patches touch

constexpr double kAbove = 5e-4;     // metres: a surface that touches there does not hide the place
constexpr double kTouching = 1e-3;  // metres
constexpr double kTouchingSteps =
    1.0 / 64;                // and steps of the lattice, since places on curves are that precise
constexpr int kGuesses = 6;  // along u and v
constexpr int kRefinements = 6;

struct Foot {
  double u, v, distance;
};

// Finds the nearest place of the patch by compass search. It needs no derivatives, which a disc's corners
// lack.
Foot foot_on(const Patch& patch, Vec3 place) {
  constexpr double kSmallest = 1e-5;  // of the patch
  Foot best{0.5, 0.5, distance(patch.place(0.5, 0.5), place)};
  for (double reach = 0.25; reach > kSmallest;) {
    const Foot middle = best;
    for (const double right : {-reach, 0.0, reach}) {
      for (const double up : {-reach, 0.0, reach}) {
        const double u = std::clamp(middle.u + right, 0.0, 1.0), v = std::clamp(middle.v + up, 0.0, 1.0);
        const double way = distance(patch.place(u, v), place);
        if (way < best.distance) best = {u, v, way};
      }
    }
    if (best.distance == middle.distance) reach *= 0.5;
  }
  return best;
}

bool all_around_sampled(const Lattice& lattice, const Foot& foot) {
  const double column = foot.u * (lattice.columns - 1), row = foot.v * (lattice.rows - 1);
  for (const double x : {std::floor(column), std::ceil(column)})
    for (const double y : {std::floor(row), std::ceil(row)})
      if (!lattice.is_sampled(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y))) return false;
  return true;
}

class Junctions {
 public:
  Junctions(const std::vector<Lattice>& lattices, const Visibility& visibility)
      : lattices_(lattices), visibility_(visibility) {
    for (const Lattice& lattice : lattices) {
      constexpr double kFar = std::numeric_limits<double>::infinity();
      Bounds bounds{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
      for (std::int32_t row = 0; row < lattice.rows; ++row) {
        for (std::int32_t column = 0; column < lattice.columns; ++column) {
          const Vec3 p = lattice.at(column, row).position;
          bounds.low = {std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y),
                        std::min(bounds.low.z, p.z)};
          bounds.high = {std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y),
                         std::max(bounds.high.z, p.z)};
        }
      }
      bounds_.push_back(bounds);
    }
  }

  // Whether another patch passes through this place of a curve, and is sampled there. It can only at the end
  // of a patch, at the foot of a thing, around an opening, and in a gap that was closed.
  bool surface_goes_on(const CurveNode& place, std::size_t patch) const {
    const bool shadow = place.cause.kind == Cause::kShadow;
    const bool closed = place.cause.kind == Cause::kNone;
    const bool opening = place.cause.kind == Cause::kDoor;
    if (!place.at_end && !shadow && !closed && !opening) return false;
    const Vec3 p = place.position + kAbove * place.normal;
    for (std::size_t other = 0; other < lattices_.size(); ++other) {
      const Lattice& lattice = lattices_[other];
      if (other == patch || (shadow && lattice.patch.shape != place.cause.number)) continue;
      // A curve through a closed gap keeps to the lattice.
      const double step = std::max(lattice.step, lattices_[patch].step);
      const double reach = closed ? step : kTouching + kTouchingSteps * step;
      const auto [low, high] = bounds_[other];
      if (p.x < low.x - reach || p.y < low.y - reach || p.z < low.z - reach || p.x > high.x + reach ||
          p.y > high.y + reach || p.z > high.z + reach)
        continue;
      const Foot foot = foot_on(lattice.patch, p);
      if (foot.distance > reach) continue;
      const ScenePoint touched{lattice.patch.place(foot.u, foot.v), lattice.patch.normal(foot.u, foot.v),
                               lattice.patch.shape, lattice.patch.two_sided};
      if (all_around_sampled(lattice, foot) || visibility_.any(touched)) return true;
    }
    return false;
  }

 private:
  struct Bounds {
    Vec3 low, high;
  };

  const std::vector<Lattice>& lattices_;
  const Visibility& visibility_;
  std::vector<Bounds> bounds_;  // of the patches
};

// ---- Curves over several patches

constexpr double kShort = 1;  // spacings: shorter pieces are scraps of junctions
constexpr double kOwnEnd =
    2.5;  // a piece may close on itself if it is so many times as long as the way across
constexpr double kOtherEnd = 4;  // the way to another is at most so many times as long as both
constexpr double kLongWay = 8;   // spacings

double length_of(const Curve& piece) {
  double length = 0;
  for (std::size_t i = 1; i < piece.size(); ++i) length += distance(piece[i - 1].position, piece[i].position);
  return length;
}

// Cuts the pieces out of a closed curve at whose places `kept` is true. Returns false, and no piece, if that
// is the whole curve.
bool cut(const Curve& curve, const std::vector<bool>& kept, std::vector<Curve>& pieces) {
  const auto first_gap = static_cast<std::size_t>(std::find(kept.begin(), kept.end(), false) - kept.begin());
  if (first_gap == curve.size()) return false;
  Curve piece;
  for (std::size_t i = 1; i <= curve.size(); ++i) {
    const std::size_t at = (first_gap + i) % curve.size();
    if (kept[at]) {
      piece.push_back(curve[at]);
    } else if (!piece.empty()) {
      pieces.push_back(std::exchange(piece, {}));
    }
  }
  return true;
}

// Piece p has the ends 2 p and 2 p + 1.
const CurveNode& end_of(const std::vector<Curve>& pieces, std::size_t end) {
  const Curve& piece = pieces[end / 2];
  return end % 2 == 0 ? piece.front() : piece.back();
}

constexpr auto kNone = std::numeric_limits<std::size_t>::max();

// Returns the end that each end is joined to, if any.
std::vector<std::size_t> partners(const std::vector<Curve>& pieces) {
  std::vector<double> lengths;
  for (const Curve& piece : pieces) lengths.push_back(length_of(piece));
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < 2 * pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < 2 * pieces.size(); ++b) {
      const double way = distance(end_of(pieces, a).position, end_of(pieces, b).position);
      const bool own = a / 2 == b / 2;
      if (own ? kOwnEnd * way < lengths[a / 2] : way < kOtherEnd * (lengths[a / 2] + lengths[b / 2]))
        pairs.emplace_back(way, a, b);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> partner(2 * pieces.size(), kNone);
  for (const auto& [way, a, b] : pairs) {
    if (partner[a] != kNone || partner[b] != kNone) continue;
    partner[a] = b;
    partner[b] = a;
  }
  return partner;
}

// Returns the first end of a sequence of joined pieces: the one without a partner, or this one in a ring.
std::size_t start_of(std::size_t end, const std::vector<std::size_t>& partner) {
  for (std::size_t at = end; partner[at] != kNone;) {
    at = partner[at] ^ 1;
    if (at == end) return end;
    if (partner[at] == kNone) return at;
  }
  return end;
}

void join(const std::vector<Curve>& pieces, std::vector<Curve>& closed) {
  const std::vector<std::size_t> partner = partners(pieces);
  std::vector<bool> taken(pieces.size());
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (taken[piece]) continue;
    Curve curve;
    std::size_t entry = start_of(2 * piece, partner);
    while (entry != kNone && !taken[entry / 2]) {
      taken[entry / 2] = true;
      const Curve& next = pieces[entry / 2];
      if (entry % 2 == 0)
        curve.insert(curve.end(), next.begin(), next.end());
      else
        curve.insert(curve.end(), next.rbegin(), next.rend());
      entry = partner[entry ^ 1];
    }
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const CurveNode& next = curve[i + 1 < curve.size() ? i + 1 : 0];
      curve[i].long_way =
          distance(curve[i].position, next.position) > kLongWay * std::max(curve[i].spacing, next.spacing);
    }
    closed.push_back(std::move(curve));
  }
}

// ---- Steps of density

constexpr double kJump = 2;  // of the spacing

Lattice sampled_by(const Lattice& lattice, std::size_t station, std::size_t stations) {
  Lattice own = lattice;
  for (std::size_t node = 0; node < own.sampled.size(); ++node)
    own.sampled[node] = lattice.by_station[node * stations + station];
  return own;
}

}  // namespace

std::vector<Curve> boundary_curves(const std::vector<Lattice>& lattices, const Visibility& visibility) {
  const Junctions junctions(lattices, visibility);
  std::vector<Curve> closed, pieces;
  for (std::size_t patch = 0; patch < lattices.size(); ++patch) {
    for (Curve& curve : patch_curves(lattices[patch], visibility)) {
      std::vector<bool> kept;
      for (const CurveNode& place : curve) kept.push_back(!junctions.surface_goes_on(place, patch));
      std::vector<Curve> own;
      if (!cut(curve, kept, own)) closed.push_back(std::move(curve));
      for (Curve& piece : own)
        if (length_of(piece) > kShort * piece.front().spacing) pieces.push_back(std::move(piece));
    }
  }
  join(pieces, closed);
  return closed;
}

std::vector<Curve> density_steps(const std::vector<Lattice>& lattices, const Scanner& scanner,
                                 const Visibility& visibility) {
  std::vector<Curve> steps;
  const std::size_t stations = scanner.stations().size();
  for (std::uint32_t station = 0; stations > 1 && station < stations; ++station) {
    const Visibility own = visibility.only(station), others = visibility.without(station);
    for (const Lattice& lattice : lattices) {
      const auto is_step = [&](const CurveNode& at) {
        if (at.at_end) return false;
        const ScenePoint place{at.position, at.normal, at.shape, lattice.patch.two_sided};
        return others.spacing(place) >= kJump * visibility.spacing(place);
      };
      for (const Curve& curve : patch_curves(sampled_by(lattice, station, stations), own)) {
        std::vector<bool> kept;
        for (const CurveNode& place : curve) kept.push_back(is_step(place));
        if (cut(curve, kept, steps)) continue;
        steps.push_back(curve);
        steps.back().push_back(curve.front());
      }
    }
  }
  return steps;
}

}  // namespace lacuna::synth
