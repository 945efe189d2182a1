// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/patch_curves.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>

namespace lacuna::synth {

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

}  // namespace

std::vector<Curve> patch_curves(const Lattice& lattice, const Visibility& visibility) {
  return Tracer(lattice, visibility).curves();
}

}  // namespace lacuna::synth
