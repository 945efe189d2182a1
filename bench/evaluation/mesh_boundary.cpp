// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/mesh_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::evaluation {
namespace {

using Positions = std::span<const Eigen::Vector3d>;

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

// A half edge of a triangle (from, to, apex).
struct HalfEdge {
  std::uint64_t from, to, apex;

  std::pair<std::uint64_t, std::uint64_t> ends() const { return std::minmax(from, to); }
  std::uint64_t end_beside(std::uint64_t vertex) const { return from == vertex ? to : from; }
};

std::vector<HalfEdge> edges_on_one_triangle(std::span<const Triangle> triangles,
                                            std::span<const std::uint64_t> stand_ins) {
  std::vector<HalfEdge> all;
  for (const Triangle& triangle : triangles) {
    const std::uint64_t a = stand_ins[triangle[0]], b = stand_ins[triangle[1]], c = stand_ins[triangle[2]];
    if (a == b || b == c || c == a) continue;
    all.insert(all.end(), {HalfEdge{a, b, c}, HalfEdge{b, c, a}, HalfEdge{c, a, b}});
  }
  std::sort(all.begin(), all.end(), [](const HalfEdge& x, const HalfEdge& y) { return x.ends() < y.ends(); });
  std::vector<HalfEdge> once;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    while (end < all.size() && all[end].ends() == all[i].ends()) ++end;
    if (end - i == 1) once.push_back(all[i]);
  }
  return once;
}

// Returns twice the area, along the normal.
Eigen::Vector3d normal_of(const HalfEdge& edge, Positions positions) {
  const Eigen::Vector3d& p = positions[edge.from];
  return (positions[edge.to] - p).cross(positions[edge.apex] - p);
}

// Returns the turn about the axis, counterclockwise from its tip: above 0, up to a whole one.
double turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d y = axis.cross(from), x = y.cross(axis);
  const double angle = std::atan2(to.dot(y) * axis.norm(), to.dot(x));
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

class BoundaryCurves {
 public:
  BoundaryCurves(std::vector<HalfEdge> edges, Positions positions)
      : edges_(std::move(edges)), positions_(positions), used_(edges_.size()) {
    for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
      ends_.emplace_back(edges_[edge].from, edge);
      ends_.emplace_back(edges_[edge].to, edge);
    }
    std::sort(ends_.begin(), ends_.end());
    on_path_.assign(ends_.size(), kNowhere);
  }

  std::vector<TrueLoop> loops() {
    for (const bool open : {true, false}) {
      for (const auto& [vertex, edge] : ends_) {
        while (!used_[edge] && (!open || unused_at(vertex).size() % 2 == 1)) walk(vertex);
      }
    }
    std::sort(loops_.begin(), loops_.end(), [](const TrueLoop& a, const TrueLoop& b) {
      return std::tie(a.vertices, a.edges) < std::tie(b.vertices, b.edges);
    });
    return std::move(loops_);
  }

 private:
  using End = std::pair<std::uint64_t, std::size_t>;  // a vertex and an edge there

  std::size_t first_end(std::uint64_t vertex) const {
    return static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), End(vertex, 0)) -
                                    ends_.begin());
  }

  std::vector<std::size_t> unused_at(std::uint64_t vertex) const {
    std::vector<std::size_t> edges;
    for (std::size_t i = first_end(vertex); i < ends_.size() && ends_[i].first == vertex; ++i) {
      if (!used_[ends_[i].second]) edges.push_back(ends_[i].second);
    }
    return edges;
  }

  bool leaves(std::size_t edge, std::uint64_t vertex) const { return edges_[edge].from == vertex; }

  Eigen::Vector3d direction(std::uint64_t vertex, std::size_t edge) const {
    return positions_[edges_[edge].end_beside(vertex)] - positions_[vertex];
  }

  // Returns where the curve goes on from the vertex that it reached on `last`; empty if it ends.
  std::optional<std::size_t> edge_after(std::size_t last, std::uint64_t vertex) const {
    std::vector<std::size_t> next = unused_at(vertex);
    const bool leaving = !leaves(last, vertex);
    const auto opposes = [&](std::size_t edge) { return leaves(edge, vertex) != leaving; };
    if (!std::all_of(next.begin(), next.end(), opposes)) std::erase_if(next, opposes);
    if (next.empty()) return std::nullopt;
    if (next.size() == 1) return next.front();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    for (std::size_t i = first_end(vertex); i < ends_.size() && ends_[i].first == vertex; ++i) {
      axis += normal_of(edges_[ends_[i].second], positions_);
    }
    if (!leaving) axis = -axis;  // the gap is on the other side
    const Eigen::Vector3d from = direction(vertex, last);
    const auto turn = [&](std::size_t edge) { return turn_between(from, direction(vertex, edge), axis); };
    return *std::min_element(next.begin(), next.end(),
                             [&](std::size_t a, std::size_t b) { return turn(a) < turn(b); });
  }

  // Follows a curve until it closes or ends, and makes a loop of every part that closes before.
  void walk(std::uint64_t start) {
    const std::vector<std::size_t> first = unused_at(start);
    const auto leaving =
        std::find_if(first.begin(), first.end(), [&](std::size_t edge) { return leaves(edge, start); });
    std::optional<std::size_t> edge = leaving == first.end() ? first.front() : *leaving;
    std::vector<End> path;
    std::uint64_t vertex = start;
    while (edge) {
      used_[*edge] = true;
      on_path_[first_end(vertex)] = path.size();
      path.emplace_back(vertex, *edge);
      vertex = edges_[*edge].end_beside(vertex);
      if (const std::size_t place = on_path_[first_end(vertex)]; place != kNowhere) cut(path, place);
      edge = path.empty() ? std::nullopt : edge_after(*edge, vertex);
    }
    if (path.empty()) return;
    cut(path, 0);
    loops_.back().vertices.push_back(vertex);
    std::sort(loops_.back().vertices.begin(), loops_.back().vertices.end());
  }

  // Makes a loop of the path from a place on.
  void cut(std::vector<End>& path, std::size_t place) {
    TrueLoop& loop = loops_.emplace_back();
    for (std::size_t i = place; i < path.size(); ++i) {
      const auto& [vertex, edge] = path[i];
      on_path_[first_end(vertex)] = kNowhere;
      loop.vertices.push_back(vertex);
      loop.edges.push_back({vertex, edges_[edge].end_beside(vertex)});
    }
    std::sort(loop.vertices.begin(), loop.vertices.end());
    path.resize(place);
  }

  std::vector<HalfEdge> edges_;
  Positions positions_;
  std::vector<bool> used_;            // of each edge
  std::vector<End> ends_;             // ascending
  std::vector<std::size_t> on_path_;  // of the first end of each vertex, its place on the path
  std::vector<TrueLoop> loops_;
};

}  // namespace

std::vector<TrueLoop> mesh_boundary(std::span<const Triangle> triangles,
                                    std::span<const std::uint64_t> stand_ins, Positions positions) {
  return BoundaryCurves(edges_on_one_triangle(triangles, stand_ins), positions).loops();
}

}  // namespace lacuna::evaluation
