// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/boundary_curves.hpp"

#include "bench/synth/junctions.hpp"
#include "bench/synth/patch_curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

namespace lacuna::synth {

namespace {

constexpr double kShort = 1;  // spacings: shorter pieces are scraps of junctions
constexpr double kOwnEnd =
    2.5;  // a piece may close on itself if it is so many times as long as the way across
constexpr double kOtherEnd = 4;  // the way to another is at most so many times as long as both
constexpr double kLongWay = 8;   // spacings

double distance(const CurveNode& a, const CurveNode& b) {
  const Vec3 arm = b.position - a.position;
  return std::sqrt(dot(arm, arm));
}

double length_of(const Curve& piece) {
  double length = 0;
  for (std::size_t i = 1; i < piece.size(); ++i) length += distance(piece[i - 1], piece[i]);
  return length;
}

// Holds the curves of all patches, one after the other.
struct PatchCurves {
  std::vector<Curve> curves;
  std::vector<std::size_t> patches;  // of each curve
};

PatchCurves trace(const std::vector<Lattice>& lattices, const Visibility& visibility) {
  PatchCurves all;
  for (std::size_t patch = 0; patch < lattices.size(); ++patch) {
    for (Curve& curve : patch_curves(lattices[patch], visibility)) {
      all.curves.push_back(std::move(curve));
      all.patches.push_back(patch);
    }
  }
  return all;
}

// Returns whether the surface goes on, on another patch, at each place of each curve, in order.
std::vector<bool> junctions(const PatchCurves& all, const std::vector<Lattice>& lattices,
                            const Visibility& visibility) {
  const Junctions patches(lattices, visibility);
  std::vector<bool> joined;
  for (std::size_t curve = 0; curve < all.curves.size(); ++curve)
    for (const CurveNode& place : all.curves[curve])
      joined.push_back(patches.surface_goes_on(place, all.patches[curve]));
  return joined;
}

// Cuts out the parts of a curve outside of its junctions: the curve itself, or pieces with ends.
void cut(const Curve& curve, const std::vector<bool>& joined, std::size_t offset, std::vector<Curve>& closed,
         std::vector<Curve>& pieces) {
  const auto begin = joined.begin() + static_cast<std::ptrdiff_t>(offset);
  const auto end = begin + static_cast<std::ptrdiff_t>(curve.size());
  const auto first = static_cast<std::size_t>(std::find(begin, end, true) - begin);
  if (first == curve.size()) {
    closed.push_back(curve);
    return;
  }
  Curve piece;
  for (std::size_t i = 1; i <= curve.size(); ++i) {
    const std::size_t at = (first + i) % curve.size();
    if (!joined[offset + at]) {
      piece.push_back(curve[at]);
    } else if (!piece.empty()) {
      if (length_of(piece) > kShort * piece.front().spacing) pieces.push_back(std::move(piece));
      piece.clear();
    }
  }
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
      const double way = distance(end_of(pieces, a), end_of(pieces, b));
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
      curve[i].long_way = distance(curve[i], next) > kLongWay * std::max(curve[i].spacing, next.spacing);
    }
    closed.push_back(std::move(curve));
  }
}

}  // namespace

std::vector<Curve> boundary_curves(const std::vector<Lattice>& lattices, const Visibility& visibility) {
  const PatchCurves all = trace(lattices, visibility);
  const std::vector<bool> joined = junctions(all, lattices, visibility);
  std::vector<Curve> closed, pieces;
  std::size_t offset = 0;
  for (const Curve& curve : all.curves) {
    cut(curve, joined, offset, closed, pieces);
    offset += curve.size();
  }
  join(pieces, closed);
  return closed;
}

}  // namespace lacuna::synth
