// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference.hpp"

#include "engine/model/length_bins.hpp"
#include "engine/model/mixed.hpp"
#include "engine/run/error.hpp"
#include "engine/simd/maths.hpp"
#include "tests/support/point_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/Dense>

namespace lacuna::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;
using Positions = std::vector<Vector3d>;

// An adjacency list with a row for every id of the input.
using Graph = std::vector<std::vector<PointId>>;

double squared_length(const Vector3d& d) {
  return (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
}
double length(const Vector3d& d) {
  return std::sqrt(squared_length(d));
}
double rounded(double weight) {
  return std::nearbyint(weight * 0x1p24) * 0x1p-24;
}

// ---- Input -------------------------------------------------------------------------------------------

void find_distinct(const Positions& positions, Detection& result) {
  std::map<std::array<double, 3>, PointId> first_at;  // -0 compares equal to 0
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const PointId id{i};
    const Vector3d& p = positions[i];
    result.points[i].representative = id;
    result.points[i].dropped = !p.allFinite();
    if (result.points[i].dropped) continue;
    const auto [entry, is_new] = first_at.try_emplace({p.x(), p.y(), p.z()}, id);
    result.points[i].representative = entry->second;
    if (is_new) result.distinct.push_back(id);
  }
}

// ---- 1. Neighbourhoods and the proximity graph -------------------------------------------------------

// A neighbour in the order of neighbours.
using Neighbour = std::pair<double, PointId>;  // squared distance, id

double eps_in_effect(const Positions& positions, const std::vector<PointId>& distinct,
                     const NeighbourhoodConfig& config) {
  if (distinct.empty()) return config.eps;
  Vector3d low = positions[value(distinct[0])], high = low;
  for (PointId id : distinct) {
    low = low.cwiseMin(positions[value(id)]);
    high = high.cwiseMax(positions[value(id)]);
  }
  const double diagonal = length(high - low);
  if (!std::isfinite(diagonal)) throw Error("squared distances overflow");
  return config.eps_fraction > 0 ? config.eps_fraction * diagonal : config.eps;
}

void find_neighbours(const Positions& positions, const NeighbourhoodConfig& config, Detection& result) {
  result.eps = eps_in_effect(positions, result.distinct, config);
  Positions places;
  for (PointId p : result.distinct) places.push_back(positions[value(p)]);
  const PointTree tree(places, result.distinct);
  std::vector<std::vector<Neighbour>> closure(positions.size());
  std::vector<lacuna::Neighbour> nearest, ball;
  for (LocalIndex at = 0; at < places.size(); ++at) {
    const PointId p = result.distinct[at];
    tree.nearest(at, static_cast<std::size_t>(config.k), nearest);
    tree.within(at, result.eps * result.eps, ball);
    nearest.insert(nearest.end(), ball.begin(), ball.end());
    for (const auto& [squared, q, there] : nearest) {
      if (squared == 0) throw Error("the squared distance of distinct points underflows");
      closure[value(p)].emplace_back(squared, q);
      closure[value(q)].emplace_back(squared, p);
    }
  }

  std::uint64_t ends = 0;
  double total_length = 0;  // every edge from both ends
  for (PointId p : result.distinct) {
    auto& row = closure[value(p)];
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    double sum = 0;
    for (const auto& [squared, q] : row) {
      result.points[value(p)].neighbours.push_back(q);
      sum += std::sqrt(squared);
    }
    if (!row.empty()) result.points[value(p)].mean_distance = sum / row.size();
    ends += row.size();
    total_length += sum;
  }
  if (!result.distinct.empty()) result.mean_neighbours = double(ends) / result.distinct.size();
  if (ends > 0) result.mean_edge_length = total_length / ends;
}

// ---- 2. and 3. Normals and criteria ------------------------------------------------------------------

// The neighbours of a point as offsets q - p, in order.
using Offsets = std::vector<Vector3d>;

struct Moments {
  Vector3d mean{0, 0, 0};  // mu_p - p
  Matrix3d covariance = Matrix3d::Zero();
};

// 3, halfdisc and shape: both weighted by exp(-d^2 / sigma^2).
Moments weighted_moments(const Offsets& offsets, double sigma) {
  std::vector<double> weights;
  double total = 0;
  Moments moments;
  for (const Vector3d& q : offsets) {
    // The engine's exp (tests/engine/simd/maths_test compares it with the standard library's). Where two
    // eigenvalues are equal but for rounding, the last bits of the weights decide where the normal points.
    weights.push_back(exponential(squared_length(q) * (-1 / (sigma * sigma))));
    total += weights.back();
    moments.mean += weights.back() * q;
  }
  if (total == 0) return {};
  moments.mean /= total;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Vector3d d = moments.mean - offsets[i];
    moments.covariance += weights[i] * d * d.transpose();
  }
  return moments;
}

struct AngleOutcome {
  double probability = 1;
  std::optional<std::array<std::size_t, 2>> gap;  // places in the order of neighbours, nearer first
};

// 3, angle.
AngleOutcome angle_criterion(const Offsets& offsets, const Vector3d& normal, double cone) {
  struct Direction {
    double angle;
    std::size_t place;  // in the order of neighbours
  };
  constexpr double kSame = 1e-9;  // radians

  const Vector3d u = normal.unitOrthogonal();
  const Vector3d v = normal.cross(u);
  std::vector<Direction> used;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Vector3d& q = offsets[i];
    const double x = u.dot(q), y = v.dot(q);
    if (cone > 0 && std::abs(normal.dot(q)) > std::cos(cone * pi / 180) * length(q)) continue;
    if (std::hypot(x, y) <= 1e-12 * length(q)) continue;  // projects onto p
    used.push_back({std::atan2(y, x), i});
  }
  if (used.empty()) return {};
  std::sort(used.begin(), used.end(),
            [](const Direction& a, const Direction& b) { return a.angle < b.angle; });

  // Runs of one direction, each replaced by its nearest neighbour; the last may go on across pi.
  std::vector<Direction> directions;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const bool same = i > 0 && used[i].angle - used[i - 1].angle <= kSame;
    if (!same) {
      directions.push_back(used[i]);
    } else if (used[i].place < directions.back().place) {
      directions.back() = used[i];
    }
  }
  if (directions.size() > 1 && used.front().angle + 2 * pi - used.back().angle <= kSame) {
    if (directions.back().place < directions.front().place) directions.front() = directions.back();
    directions.pop_back();
  }

  struct Gap {
    double size;
    std::array<std::size_t, 2> pair;
  };
  std::vector<Gap> gaps;
  double largest = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Direction& a = directions[i];
    const Direction& b = directions[(i + 1) % directions.size()];
    double size = b.angle - a.angle;
    if (size <= 0) size += 2 * pi;
    gaps.push_back({size, {std::min(a.place, b.place), std::max(a.place, b.place)}});
    largest = std::max(largest, size);
  }
  AngleOutcome outcome;
  for (const Gap& gap : gaps) {
    if (gap.size >= largest - kSame && (!outcome.gap || gap.pair < *outcome.gap)) outcome.gap = gap.pair;
  }
  const double m = double(used.size());
  if (m >= 3) outcome.probability = std::clamp((largest - 2 * pi / m) / (pi - 2 * pi / m), 0., 1.);
  return outcome;
}

// 3, halfdisc.
double halfdisc_criterion(const Vector3d& mean, const Vector3d& normal, double r) {
  const Vector3d projected = mean - normal.dot(mean) * normal;
  return std::min(length(projected) / (4 * r / (3 * pi)), 1.);
}

// 3, shape: Lambda_p, from ascending eigenvalues.
Vector3d normalised_eigenvalues(const Vector3d& eigenvalues) {
  const Vector3d lambda = eigenvalues.reverse().cwiseMax(0);
  return lambda.sum() > 0 ? Vector3d(lambda / lambda.sum()) : Vector3d::Constant(1. / 3);
}

// 3, shape: of the boundary, and of boundary and interior together.
struct ShapeShares {
  double boundary, surface;
};
ShapeShares shape_shares(const Vector3d& lambda) {
  const std::array<Vector3d, 4> characteristic{Vector3d(2. / 3, 1. / 3, 0), Vector3d(1. / 2, 1. / 2, 0),
                                               Vector3d(1. / 3, 1. / 3, 1. / 3), Vector3d(1, 0, 0)};
  const Vector3d centroid(11. / 18, 5. / 18, 1. / 9);
  std::array<double, 4> kernels;
  for (int i = 0; i < 4; ++i) {
    const double s = length(characteristic[i] - centroid) / 3;
    kernels[i] = std::exp(-squared_length(lambda - characteristic[i]) / (s * s));
  }
  const double sum = kernels[0] + kernels[1] + kernels[2] + kernels[3];
  return sum > 0 ? ShapeShares{kernels[0] / sum, (kernels[0] + kernels[1]) / sum} : ShapeShares{0, 0};
}

// 2: as given, normalised; none where it is zero or not finite.
std::optional<Vector3d> given_normal(const std::vector<Vector3d>& normals, PointId p) {
  if (normals.empty()) return std::nullopt;
  const Vector3d& n = normals[value(p)];
  if (!n.allFinite() || n.isZero(0)) return std::nullopt;
  return (n / n.cwiseAbs().maxCoeff()).normalized();
}

// 2: the eigenvector of the smallest eigenvalue; none where it is not the smallest alone.
std::optional<Vector3d> estimated_normal(const Eigen::SelfAdjointEigenSolver<Matrix3d>& eigen) {
  const Vector3d& values = eigen.eigenvalues();  // ascending
  if (values[1] - values[0] <= 1e-12 * values.sum()) return std::nullopt;
  return eigen.eigenvectors().col(0).normalized();
}

// 2, creases: turned by 90 degrees about the axis through the projected gap neighbours.
std::optional<Vector3d> turned_normal(const Vector3d& normal, const Vector3d& g1, const Vector3d& g2) {
  Vector3d axis = g2 - g1;
  axis -= normal.dot(axis) * normal;
  if (length(axis) <= 1e-12 * (length(g1) + length(g2))) return std::nullopt;
  return axis.cross(normal).normalized();
}

void evaluate(const Positions& positions, const std::vector<Vector3d>& given, const Config& config,
              PointId id, Point& point) {
  if (point.neighbours.empty()) return;  // all probabilities 1
  const CriteriaConfig& criteria = config.criteria;
  Offsets offsets;
  for (PointId q : point.neighbours) offsets.push_back(positions[value(q)] - positions[value(id)]);

  const Moments moments = weighted_moments(offsets, criteria.sigma * point.mean_distance);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(moments.covariance);
  point.surface = moments.mean;
  const Vector3d lambda = normalised_eigenvalues(eigen.eigenvalues());
  point.lambda = {lambda[0], lambda[1], lambda[2]};
  point.shape = shape_shares(lambda).boundary;
  point.surface_share = shape_shares(lambda).surface;

  point.normal = estimated_normal(eigen);
  const std::optional<Vector3d> as_given = given_normal(given, id);
  const bool is_off =
      as_given && point.normal && std::abs(as_given->dot(*point.normal)) < std::numbers::sqrt2 / 2;
  const bool estimated = !as_given || (is_off && config.normals.use == NormalsUse::kFitting);
  if (!estimated) point.normal = as_given;
  if (point.normal) {
    AngleOutcome angle = angle_criterion(offsets, *point.normal, criteria.cone);
    if (estimated && angle.probability > config.normals.crease_threshold && angle.gap) {
      const auto [g1, g2] = *angle.gap;
      if (const auto turned = turned_normal(*point.normal, offsets[g1], offsets[g2])) {
        const AngleOutcome again = angle_criterion(offsets, *turned, criteria.cone);
        point.turned = again.probability < angle.probability / 2;
        point.turned_by_rounding = std::abs(again.probability - angle.probability / 2) <= 1e-9;
        if (point.turned) point.normal = turned, angle = again;
      }
    }
    point.angle = angle.probability;
    point.halfdisc = halfdisc_criterion(moments.mean, *point.normal, point.mean_distance);
    if (angle.gap) point.gap = {point.neighbours[(*angle.gap)[0]], point.neighbours[(*angle.gap)[1]]};
  }

  const std::vector<double>& weights = criteria.weights;
  const double total = (weights[0] + weights[1]) + weights[2];
  point.combined = (weights[0] / total * point.angle + weights[1] / total * point.halfdisc) +
                   weights[2] / total * point.shape;
  point.probability = rounded(point.combined);
}

// ---- 2. Orientation ----------------------------------------------------------------------------------

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  // False if they were one already.
  bool join(PointId a, PointId b) {
    const std::size_t root_a = root(value(a)), root_b = root(value(b));
    parent_[root_a] = root_b;
    return root_a != root_b;
  }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<std::size_t> parent_;
};

bool by_weight_then_ids(const Edge& a, const Edge& b) {
  return std::tie(a.weight, a.low, a.high) < std::tie(b.weight, b.low, b.high);
}

// Whether the normal of a root points up: to +z; a horizontal one to +y, else to +x.
bool points_up(const Vector3d& n) {
  if (n.z() != 0) return n.z() > 0;
  return n.y() != 0 ? n.y() > 0 : n.x() > 0;
}

// Hoppe et al. 1992, over the points of G that have a normal.
void orient_normals(const Positions& positions, Detection& result) {
  std::vector<Edge> edges;
  for (PointId p : result.distinct) {
    const Point& point = result.points[value(p)];
    for (PointId q : point.neighbours) {
      const Point& other = result.points[value(q)];
      if (p < q && point.normal && other.normal) {
        edges.push_back({p, q, 1 - std::abs(point.normal->dot(*other.normal))});
      }
    }
  }
  std::sort(edges.begin(), edges.end(), by_weight_then_ids);
  UnionFind components(positions.size());
  Graph tree(positions.size());
  for (const Edge& edge : edges) {
    if (!components.join(edge.low, edge.high)) continue;
    tree[value(edge.low)].push_back(edge.high);
    tree[value(edge.high)].push_back(edge.low);
  }

  // From the highest point not yet reached, which is its component's highest.
  std::vector<PointId> roots = result.distinct;
  std::stable_sort(roots.begin(), roots.end(),
                   [&](PointId a, PointId b) { return positions[value(a)].z() > positions[value(b)].z(); });
  for (PointId root : roots) {
    Point& highest = result.points[value(root)];
    if (!highest.normal || highest.oriented_normal) continue;
    highest.is_top = true;
    highest.oriented_normal = points_up(*highest.normal) ? *highest.normal : Vector3d(-*highest.normal);
    std::vector<PointId> reached{root};
    while (!reached.empty()) {
      const PointId p = reached.back();
      reached.pop_back();
      const Vector3d normal = *result.points[value(p)].oriented_normal;
      for (PointId q : tree[value(p)]) {
        Point& other = result.points[value(q)];
        if (other.oriented_normal) continue;
        other.oriented_normal = normal.dot(*other.normal) < 0 ? Vector3d(-*other.normal) : *other.normal;
        reached.push_back(q);
      }
    }
  }
}

// ---- 4. Coherence ------------------------------------------------------------------------------------

void find_coherent(const CoherenceConfig& config, Detection& result) {
  std::vector<Point>& points = result.points;
  for (PointId p : result.distinct)
    points[value(p)].coherent = points[value(p)].probability > config.threshold;
  for (bool changed = true; changed;) {
    changed = false;
    for (PointId p : result.distinct) {
      Point& point = points[value(p)];
      const bool stays = point.coherent && point.gap && points[value((*point.gap)[0])].coherent &&
                         points[value((*point.gap)[1])].coherent;
      changed |= stays != point.coherent;
      point.coherent = stays;
    }
  }
}

// ---- 5. Minimum spanning graph -----------------------------------------------------------------------

void find_eligible(const Positions& positions, const SpanningConfig& config, Detection& result) {
  for (PointId i : result.distinct) {
    const Point& a = result.points[value(i)];
    for (PointId j : a.neighbours) {
      if (j < i) continue;
      const Point& b = result.points[value(j)];
      const double w_prob = 2 - a.probability - b.probability;
      const double distance = length(positions[value(j)] - positions[value(i)]);
      const double w_density = rounded(2 * distance / (a.mean_distance + b.mean_distance));
      const double w_total = w_prob + w_density;
      if (w_prob < config.max_prob_weight && w_total < config.max_total_weight) {
        result.eligible.push_back({i, j, w_total});
      }
    }
  }
  std::sort(result.eligible.begin(), result.eligible.end(), by_weight_then_ids);
}

// Whether a path of at most `steps` edges leads from a to b. `seen` is all false before and after.
bool path_within(const Graph& graph, PointId a, PointId b, std::int64_t steps, std::vector<bool>& seen) {
  std::vector<PointId> reached{a};
  seen[value(a)] = true;
  std::size_t level = 0;  // where the vertices of the last level start
  for (std::int64_t step = 0; step < steps && level < reached.size() && !seen[value(b)]; ++step) {
    const std::size_t level_end = reached.size();
    for (; level < level_end; ++level) {
      for (PointId next : graph[value(reached[level])]) {
        if (seen[value(next)]) continue;
        seen[value(next)] = true;
        reached.push_back(next);
      }
    }
  }
  const bool found = seen[value(b)];
  for (PointId vertex : reached) seen[value(vertex)] = false;
  return found;
}

Graph span(Detection& result) {
  const std::size_t count = result.points.size();
  // 2 sqrt(pi K): steps around the smallest hole that edges do not cross.
  Graph graph(count);
  UnionFind components(count);
  std::vector<bool> seen(count, false);
  for (const Edge& edge : result.eligible) {
    const bool joins = components.join(edge.low, edge.high);
    // D + 1 > e, unless a path of D <= e - 1 edges exists.
    if (!joins && path_within(graph, edge.low, edge.high, result.e - 1, seen)) continue;
    graph[value(edge.low)].push_back(edge.high);
    graph[value(edge.high)].push_back(edge.low);
  }
  return graph;
}

// ---- 6. Loops ----------------------------------------------------------------------------------------

// Takes off the trees that hang off the graph. No loop contains them, and the order in which a search reaches
// all other vertices stays. (Bridges stay; a search from one finds nothing.)
void strip_trees(Graph& graph) {
  std::vector<PointId> leaves;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    if (graph[i].size() == 1) leaves.push_back(PointId{i});
  }
  while (!leaves.empty()) {
    const PointId leaf = leaves.back();
    leaves.pop_back();
    if (graph[value(leaf)].empty()) continue;
    const PointId other = graph[value(leaf)][0];
    graph[value(leaf)].clear();
    std::erase(graph[value(other)], leaf);
    if (graph[value(other)].size() == 1) leaves.push_back(other);
  }
}

// The loop through the origin; empty if there is none.
std::vector<PointId> search_loop(const Graph& graph, PointId origin) {
  struct Reached {
    PointId parent;
    PointId branch;
  };
  std::map<PointId, Reached> reached;
  std::queue<PointId> queue;
  for (PointId neighbour : graph[value(origin)]) {
    reached[neighbour] = {origin, neighbour};
    queue.push(neighbour);
  }
  while (!queue.empty()) {
    const PointId p = queue.front();
    queue.pop();
    for (PointId q : graph[value(p)]) {
      if (q == origin) continue;
      const auto [entry, is_new] = reached.try_emplace(q, Reached{p, reached[p].branch});
      if (is_new) {
        queue.push(q);
      } else if (entry->second.branch != reached[p].branch) {
        std::vector<PointId> loop;
        for (PointId i = p; i != origin; i = reached[i].parent) loop.push_back(i);
        std::reverse(loop.begin(), loop.end());
        for (PointId i = q; i != origin; i = reached[i].parent) loop.push_back(i);
        loop.push_back(origin);
        return loop;
      }
    }
  }
  return {};
}

void find_loops(Graph graph, Detection& result) {
  strip_trees(graph);
  for (auto& row : graph) std::sort(row.begin(), row.end());
  std::vector<bool> on_loop(graph.size(), false);
  for (PointId origin : result.distinct) {
    if (on_loop[value(origin)] || graph[value(origin)].empty()) continue;
    std::vector<PointId> loop = search_loop(graph, origin);
    if (loop.empty()) continue;
    for (PointId p : loop) on_loop[value(p)] = true;
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    if (loop.back() < loop[1]) std::reverse(loop.begin() + 1, loop.end());
    result.loops.push_back(std::move(loop));
  }
  std::sort(result.loops.begin(), result.loops.end());
  result.confidences.assign(result.loops.size(), 1);
  for (PointId p : result.distinct) {
    Point& point = result.points[value(p)];
    point.boundary = point.coherent || on_loop[value(p)];
  }
}

// ---- Stars -------------------------------------------------------------------------------------------

// In the order around the point; ball: the circumradius with this corner and the next.
struct Corner {
  PointId point;
  double ball;
};

struct Star {
  std::vector<Corner> corners;
  double distance = 0;               // harmonic mean of r over the point and its neighbours
  std::array<double, 2> radius{};    // the bounds on a triangle's circumradius, by scale: fine, coarse
  std::array<double, 2> sampling{};  // nine in ten of the circumradii around within these are no larger
};

// What confidence needs of a gap.
struct Evidence {
  double length, sampling, clearness, distance, surface;
};

struct Gap {
  PointId point, from, to;
  Evidence evidence;
};

// The ids that the points of a level have in the input.
using Names = std::vector<PointId>;

double weight(const Vector3d& place, double r) {
  std::uint64_t hash = 0;
  for (const double coordinate : place) hash = mixed(hash ^ std::bit_cast<std::uint64_t>(coordinate + 0.));
  return 1e-5 * (static_cast<double>(hash >> 11) / 0x1p53) * r * r;
}

Star star_of(const Positions& positions, const Detection& result, PointId id) {
  const Point& p = result.points[value(id)];
  if (!p.normal || p.neighbours.empty()) return {};
  const Vector3d u = p.normal->unitOrthogonal(), v = p.normal->cross(u);
  const auto shift = [&](const Point& q) -> Vector3d {
    return q.normal ? Vector3d(*q.normal * q.normal->dot(q.surface)) : Vector3d(0, 0, 0);
  };
  double closeness = 1 / p.mean_distance;
  std::vector<std::pair<PointId, Eigen::Vector2d>> seen;
  for (const PointId other : p.neighbours) {
    const Point& q = result.points[value(other)];
    closeness += 1 / q.mean_distance;
    const Vector3d d = (positions[value(other)] - positions[value(id)]) + (shift(q) - shift(p));
    const double power = d.squaredNorm() + weight(positions[value(id)], p.mean_distance) -
                         weight(positions[value(other)], q.mean_distance);
    if (power > 0) seen.emplace_back(other, Eigen::Vector2d(d.dot(u), d.dot(v)) / power);
  }

  // The hull: its lower side from left to right, then its upper side back.
  const auto place = [](const auto& q) { return std::tuple(q.second.x(), q.second.y(), q.first); };
  std::sort(seen.begin(), seen.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  std::vector<std::pair<PointId, Eigen::Vector2d>> hull;
  for (int side = 0; side < 2; ++side) {
    std::vector<std::pair<PointId, Eigen::Vector2d>> chain;
    for (const auto& q : seen) {
      while (chain.size() > 1 && cross(chain.back().second - chain[chain.size() - 2].second,
                                       q.second - chain[chain.size() - 2].second) <= 0) {
        chain.pop_back();
      }
      chain.push_back(q);
    }
    hull.insert(hull.end(), chain.begin(), chain.end() - (chain.empty() ? 0 : 1));
    std::reverse(seen.begin(), seen.end());
  }
  if (hull.size() < 3) return {};
  Star star{.corners = {}, .distance = static_cast<double>(p.neighbours.size() + 1) / closeness};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d &a = hull[i].second, &b = hull[(i + 1) % hull.size()].second;
    const double height = cross(a, b) / (b - a).norm(), largest = 8 * star.distance;
    star.corners.push_back({hull[i].first, height > 0 ? std::min(1 / (2 * height), largest) : largest});
  }
  return star;
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

// Stars of points and of their neighbours, found when they are first needed.
class Stars {
 public:
  Stars(const Positions& positions, const TangentialConfig& config, const Detection& result)
      : positions_(positions), config_(config), result_(result) {}

  // Measured by the circumradii of its own and its neighbours' stars.
  const Star& operator[](PointId p) {
    const auto [at, is_new] = measured_.try_emplace(p, found(p));
    if (is_new && !at->second.corners.empty()) measure(p, at->second);
    return at->second;
  }

 private:
  const Star& found(PointId p) {
    const auto [at, is_new] = found_.try_emplace(p);
    if (is_new) at->second = star_of(positions_, result_, p);
    return at->second;
  }

  // The circumradii of a star that do not lie in a hole.
  std::vector<double> balls_of(PointId p) {
    std::vector<double> balls;
    for (const Corner& corner : found(p).corners)
      if (corner.ball <= config_.hole_radius * found(p).distance) balls.push_back(corner.ball);
    return balls;
  }

  void measure(PointId p, Star& star) {
    std::vector<PointId> around = result_.points[value(p)].neighbours;
    around.push_back(p);
    std::vector<double> circles, scatters;
    for (const PointId q : around) {
      const std::vector<double> balls = balls_of(q);
      if (balls.empty()) continue;
      circles.push_back(median(balls));
      scatters.push_back(circles.back() - *std::min_element(balls.begin(), balls.end()));
    }
    const double most = config_.most_radius * star.distance;
    const double circle = circles.empty() ? most : std::min(median(circles), most);
    const double scatter = scatters.empty() ? most : std::min(median(scatters), most);
    const double radius = config_.max_radius * circle + scatter;
    star.radius = {radius, config_.coarse_bound * radius};
    for (const std::size_t scale : {0, 1}) star.sampling[scale] = sampling(around, star.radius[scale]);
  }

  // Takes the eight smallest circumradii of each star that do not lie in a hole, to a 64th.
  double sampling(const std::vector<PointId>& around, double most) {
    std::vector<double> balls;
    for (const PointId q : around) {
      std::vector<double> own = balls_of(q);
      std::sort(own.begin(), own.end());
      if (own.size() > 8) own.resize(8);
      balls.insert(balls.end(), own.begin(), own.end());
    }
    std::erase_if(balls, [&](double ball) { return ball * (64 / most) >= 64; });
    std::sort(balls.begin(), balls.end());
    if (balls.empty()) return most;
    return (std::floor(balls[balls.size() * 9 / 10] * (64 / most)) + 1) / 64 * most;
  }

  const Positions& positions_;
  const TangentialConfig& config_;
  const Detection& result_;
  std::map<PointId, Star> found_, measured_;
};

bool has_triangle(const Star& star, PointId a, PointId b, std::size_t scale = 0) {
  const std::size_t count = star.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const PointId here = star.corners[i].point, next = star.corners[(i + 1) % count].point;
    if (star.corners[i].ball <= star.radius[scale] && ((here == a && next == b) || (here == b && next == a)))
      return true;
  }
  return false;
}

// Whether the triangle that begins at corner i of p's star is in the stars of all of its rough corners.
bool is_agreed(PointId p, std::size_t i, const std::set<PointId>& rough, Stars& stars,
               std::size_t scale = 0) {
  const Star& star = stars[p];
  const PointId a = star.corners[i].point, b = star.corners[(i + 1) % star.corners.size()].point;
  return has_triangle(star, a, b, scale) && (!rough.contains(a) || has_triangle(stars[a], p, b, scale)) &&
         (!rough.contains(b) || has_triangle(stars[b], p, a, scale));
}

// Seeds (method.md, C.4), and, again and again, the corners of triangles in their stars that are not
// agreed.
std::set<PointId> rough_points(const Detection& result, const Config& config, Stars& stars) {
  const double threshold = std::max(config.coherence.threshold, config.tangential.seed_probability);
  std::set<PointId> rough;
  for (const PointId p : result.distinct) {
    if (result.points[value(p)].probability > threshold) rough.insert(p);
  }
  for (std::size_t before = 0; before != rough.size();) {
    before = rough.size();
    const std::set<PointId> known = rough;
    for (const PointId p : known) {
      const std::vector<Corner>& corners = stars[p].corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (is_agreed(p, i, known, stars)) continue;
        rough.insert(corners[i].point);
        rough.insert(corners[(i + 1) % corners.size()].point);
      }
    }
  }
  return rough;
}

std::vector<Gap> gaps_of(PointId p, const Detection& result, const std::set<PointId>& rough, Stars& stars,
                         std::size_t scale, const Positions& positions, const TangentialConfig& config) {
  const Star& star = stars[p];
  const std::size_t count = star.corners.size();
  const auto corner = [&](std::size_t i) -> const Corner& { return star.corners[i % count]; };
  const auto agreed = [&](std::size_t i) { return is_agreed(p, i % count, rough, stars, scale); };
  const auto distance = [&](PointId q) { return length(positions[value(q)] - positions[value(p)]); };
  double surface = 0;
  for (const PointId q : result.points[value(p)].neighbours) surface += result.points[value(q)].surface_share;
  surface /= static_cast<double>(result.points[value(p)].neighbours.size());
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < count; ++i) {
    if (!agreed(i) || agreed(i + 1)) continue;
    double ball = 0;
    std::size_t end = i + 1;
    for (; !agreed(end); ++end) ball = std::max(ball, corner(end).ball);
    const PointId from = corner(i + 1).point, to = corner(end).point;
    const double sampling = star.sampling[scale];
    const double clearness = std::clamp((ball / sampling - 1) / (config.clear_radius - 1), 0., 1.);
    gaps.push_back(
        {p, from, to, {(distance(from) + distance(to)) / 2, sampling, clearness, star.distance, surface}});
  }
  return gaps;
}

struct CurvePoint {
  PointId point;
  Evidence evidence;
};

// Returns the way to write a closed curve whose keys come first.
template <class KeyOf>
std::vector<CurvePoint> first_way(std::vector<CurvePoint> rim, const KeyOf& key_of) {
  const auto keys = [&](const std::vector<CurvePoint>& way) {
    std::vector<decltype(key_of(way.front().point))> keys;
    for (const CurvePoint& p : way) keys.push_back(key_of(p.point));
    return keys;
  };
  std::vector<CurvePoint> best = rim;
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(rim.begin(), rim.end());
    for (std::size_t i = 0; i < rim.size(); ++i) {
      std::rotate(rim.begin(), rim.begin() + 1, rim.end());
      if (keys(rim) < keys(best)) best = rim;
    }
  }
  return best;
}

// Cuts off what lies between two passes of a point, until no point is passed twice.
std::vector<std::vector<CurvePoint>> simple_curves(std::vector<CurvePoint> rim) {
  std::vector<std::vector<CurvePoint>> curves;
  for (std::size_t end = 0; end < rim.size(); ++end) {
    for (std::size_t begin = 0; begin < end; ++begin) {
      if (rim[begin].point != rim[end].point) continue;
      curves.emplace_back(rim.begin() + long(begin), rim.begin() + long(end));
      rim.erase(rim.begin() + long(begin), rim.begin() + long(end));
      end = begin;
    }
  }
  curves.push_back(rim);
  return curves;
}

struct FoundLoop {
  std::vector<PointId> points;  // by their names
  std::vector<Vector3d> places;
  std::vector<Vector3d> offsets;  // from each point to the mean of its neighbours
  std::size_t level, scale;
  double clearness, surface, spacing, sampling_gap;
  double log_odds;
};
using Loops = std::vector<FoundLoop>;

// By first id, then short ones first, then by all ids.
auto order_of(const FoundLoop& loop) {
  return std::tuple(loop.points.front(), loop.points.size(), loop.points, loop.scale);
}

FoundLoop loop_of(const std::vector<CurvePoint>& rim, const TangentialConfig& config) {
  FoundLoop loop{};
  double clear = 0, length = 0, sampling = 0, distance = 0;
  const auto count = static_cast<double>(rim.size());
  for (const auto& [point, evidence] : rim) {
    loop.points.push_back(point);
    clear += evidence.clearness * evidence.length;
    length += evidence.length;
    sampling += evidence.sampling;
    distance += evidence.distance;
    loop.surface += evidence.surface / count;
  }
  loop.clearness = clear / (length + config.added_length * sampling / count);
  loop.spacing = distance / count / 1.7;
  loop.sampling_gap = sampling / distance;
  return loop;
}

// The curves at one scale of at least `min_curve` points that may be holes.
void find_curves(const Positions& positions, const Detection& result, const TangentialConfig& config,
                 const std::set<PointId>& rough, std::size_t scale, Stars& stars, std::size_t& edges,
                 Loops& loops) {
  const auto least = static_cast<std::size_t>(config.min_curve);
  std::vector<Gap> gaps;
  std::map<std::pair<PointId, PointId>, std::size_t> at;  // (point, neighbour along the curve)
  for (const PointId p : rough) {
    for (const Gap& gap : gaps_of(p, result, rough, stars, scale, positions, config)) {
      at[{p, gap.from}] = at[{p, gap.to}] = gaps.size();
      gaps.push_back(gap);
    }
  }
  edges = gaps.size();  // each ends at two, and at each of them two end
  std::vector<bool> is_done(gaps.size(), false);
  for (std::size_t start = 0; start < gaps.size(); ++start) {
    if (is_done[start]) continue;
    std::vector<CurvePoint> rim;
    std::size_t g = start;
    do {
      const PointId before = rim.empty() ? gaps[g].from : rim.back().point;
      const PointId next = gaps[g].from == before ? gaps[g].to : gaps[g].from;
      is_done[g] = true;
      rim.push_back({gaps[g].point, gaps[g].evidence});
      g = at.at({next, rim.back().point});  // curves are closed
    } while (g != start);
    if (rim.size() < least) continue;
    const auto place_of = [&](PointId p) {
      const Vector3d& place = positions[value(p)];
      return std::array{-place.x(), -place.y(), -place.z()};
    };
    for (const std::vector<CurvePoint>& curve : simple_curves(first_way(rim, place_of))) {
      if (curve.size() < least) continue;
      FoundLoop loop = loop_of(first_way(curve, [](PointId p) { return p; }), config);
      if (loop.clearness < 0.5 || loop.surface < 0.3) continue;
      loop.scale = scale;
      loops.push_back(loop);
    }
  }
}

// ---- Levels (method.md, D) ---------------------------------------------------------------------------

struct Level {
  double edge = 0;
  Positions positions;
  Positions normals;  // given ones
  Names names;        // ascending
};

// The loops of a level, of which `result` has the evaluated points.
Loops loops_of(const Level& level, std::size_t number, const Config& config, Detection& result) {
  Stars stars(level.positions, config.tangential, result);
  const std::set<PointId> rough = rough_points(result, config, stars);
  std::size_t coarse_edges = 0;
  Loops loops;
  find_curves(level.positions, result, config.tangential, rough, 0, stars, result.boundary_edges, loops);
  find_curves(level.positions, result, config.tangential, rough, 1, stars, coarse_edges, loops);
  for (FoundLoop& loop : loops) {
    loop.level = number;
    for (PointId& p : loop.points) {
      loop.places.push_back(level.positions[value(p)]);
      loop.offsets.push_back(result.points[value(p)].surface);
      p = level.names[value(p)];
    }
  }
  std::sort(loops.begin(), loops.end(),
            [](const auto& a, const auto& b) { return order_of(a) < order_of(b); });
  return loops;
}

using LatticeCell = std::array<double, 3>;

LatticeCell lattice_cell(const Vector3d& p, double edge) {
  const auto cell = [&](double x) {
    const double edges = x * (1 / edge);
    return edges >= -0.25 && edges < 0 ? 0 : std::floor(edges) + 0.;
  };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

// Keeps of each cell the point nearest to its middle, then the lowest coordinates, then the lowest id.
Level thinned(const Level& below, const Detection& result, double edge) {
  std::map<LatticeCell, PointId> nearest;
  const auto rank = [&](PointId p) {
    const Vector3d& x = below.positions[value(p)];
    const LatticeCell cell = lattice_cell(x, edge);
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = x[axis] * (1 / edge) - cell[static_cast<std::size_t>(axis)] - 0.5;
      squared += offset * offset;
    }
    return std::tuple(squared, x.x(), x.y(), x.z(), p);
  };
  for (const PointId p : result.distinct) {
    const auto [at, is_new] = nearest.try_emplace(lattice_cell(below.positions[value(p)], edge), p);
    if (!is_new && rank(p) < rank(at->second)) at->second = p;
  }
  std::set<PointId> kept;
  for (const auto& [cell, p] : nearest) kept.insert(p);
  Level level{.edge = edge, .positions = {}, .normals = {}, .names = {}};
  for (const PointId p : kept) {
    level.positions.push_back(below.positions[value(p)]);
    if (!below.normals.empty()) level.normals.push_back(below.normals[value(p)]);
    level.names.push_back(below.names[value(p)]);
  }
  return level;
}

// The first power of the square root of two above a length.
double power_above(double length) {
  const double octave = std::ldexp(1., std::ilogb(length)), half = octave * std::numbers::sqrt2;
  return half > length ? half : 2 * octave;
}

// Rounded down, in 64 steps an octave.
double in_steps(double length) {
  const int octave = std::ilogb(length);
  return std::ldexp(std::floor(std::ldexp(length, 6 - octave)), octave - 6);
}

// The share of points that a lattice leaves, by their distances to their neighbours.
double share_left(const Detection& result, double edge) {
  double left = 0, all = 0;
  for (const PointId p : result.distinct) {
    const double r = result.points[value(p)].mean_distance;
    if (!(r > 0)) continue;
    const double spacing = in_steps(r) / 1.7;
    left += 1 / (1 + edge / spacing * (edge / spacing) / 1.3 / 2);
    ++all;
  }
  return left / all;
}

// None where no level is above.
std::optional<Level> level_above(const Level& below, const Detection& result) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const PointId p : result.distinct) {
    const double r = result.points[value(p)].mean_distance;
    if (r > 0) shortest = std::min(shortest, r);
  }
  if (!std::isfinite(shortest)) return std::nullopt;
  double edge = power_above(std::max(below.edge * 1.0001, in_steps(shortest) / 4));
  while (share_left(result, edge) > 0.6) edge = power_above(edge * 1.0001);
  for (;; edge = power_above(edge * 1.0001)) {
    Level level = thinned(below, result, edge);
    if (level.names.size() < 200) return std::nullopt;
    if (static_cast<double>(level.names.size()) <= 0.9 * static_cast<double>(result.distinct.size()))
      return level;
  }
}

// ---- Tracking ----------------------------------------------------------------------------------------

std::set<LatticeCell> drawn(const FoundLoop& loop, double edge) {
  const auto cell = [&](const Vector3d& p) {
    return LatticeCell{std::floor(p.x() / edge), std::floor(p.y() / edge), std::floor(p.z() / edge)};
  };
  std::set<LatticeCell> cells;
  for (std::size_t i = 0; i < loop.places.size(); ++i) {
    const Vector3d &from = loop.places[i], &to = loop.places[(i + 1) % loop.places.size()];
    const double steps = std::min(std::ceil((to - from).norm() / edge), 16.);
    for (double step = 1; step < steps; ++step) cells.insert(cell(from + (to - from) * (step / steps)));
    cells.insert(cell(to));
  }
  return cells;
}

bool is_near(const LatticeCell& at, const std::set<LatticeCell>& cells) {
  for (const double x : {-1, 0, 1}) {
    for (const double y : {-1, 0, 1}) {
      for (const double z : {-1, 0, 1}) {
        if (cells.contains({at[0] + x, at[1] + y, at[2] + z})) return true;
      }
    }
  }
  return false;
}

float share_near(const std::set<LatticeCell>& cells, const std::set<LatticeCell>& others) {
  const auto count =
      std::count_if(cells.begin(), cells.end(), [&](const auto& c) { return is_near(c, others); });
  return static_cast<float>(count) / static_cast<float>(cells.size());
}

struct Shape {
  double length;
  Vector3d centroid, area;  // Newell
  bool is_hole;             // the points move away from each other, each by its offset
};

Shape shape_of(const FoundLoop& loop) {
  Shape shape{.length = 0, .centroid = Vector3d::Zero(), .area = Vector3d::Zero(), .is_hole = true};
  const std::size_t count = loop.places.size();
  for (const Vector3d& p : loop.places) shape.centroid += (p - loop.places[0]) / static_cast<double>(count);
  shape.centroid += loop.places[0];
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d &a = loop.places[i], &b = loop.places[(i + 1) % count];
    shape.area += (a - shape.centroid).cross(b - shape.centroid) / 2;
    shape.length += (b - a).norm();
  }
  double growth = 0, most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d along = loop.places[(i + 1) % count] - loop.places[(i + count - 1) % count];
    const Vector3d& offset = loop.offsets[i];
    growth += offset.dot(along.cross(shape.area.stableNormalized()));
    most += offset.norm() * along.norm();
  }
  shape.is_hole = !(growth < -0.1 * most);
  return shape;
}

double octaves(double ratio) {
  const double power = std::floor(std::log2(ratio));
  return power + ratio / std::exp2(power) - 1;
}

// Whether an odd number of the polygon's edges are to the right of a place.
bool is_within(const std::vector<Eigen::Vector2d>& polygon, double x, double y) {
  bool is_odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i == 0 ? polygon.size() - 1 : i - 1], &b = polygon[i];
    if (y < std::min(a.y(), b.y()) || y >= std::max(a.y(), b.y())) continue;
    if (x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) is_odd = !is_odd;
  }
  return is_odd;
}

// A loop in the plane of its centroid and normal, and the raster over it (method.md, D.3).
using Pixel = std::pair<int, int>;  // row, column

class FlatLoop {
 public:
  FlatLoop(const FoundLoop& loop, const Shape& shape) : centroid_(shape.centroid) {
    axes_.col(2) = shape.area / shape.area.stableNorm();
    Eigen::Index least = 0, largest = 0;
    axes_.col(2).cwiseAbs().minCoeff(&least);
    if (axes_.col(2).cwiseAbs().maxCoeff(&largest); axes_(largest, 2) < 0) axes_.col(2) *= -1;
    axes_.col(0) = Vector3d(axes_.col(2)).cross(Vector3d::Unit(least)).normalized();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
    for (const Vector3d& p : loop.places) {
      at.push_back((*this)(p));
      rim.emplace_back(at.back().head<2>());
    }
  }
  Vector3d operator()(const Vector3d& p) const { return axes_.transpose() * (p - centroid_); }

  std::vector<Vector3d> at;
  std::vector<Eigen::Vector2d> rim;

 private:
  Vector3d centroid_;
  Eigen::Matrix3d axes_;
};

struct Raster {
  Eigen::Vector2d corner;
  double edge;
  Eigen::Vector2i count;

  Raster(const FlatLoop& loop, double margin, double spacing) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : loop.rim) box.extend(p);
    box.min().array() -= margin;
    box.max().array() += margin;
    const double side = box.sizes().maxCoeff();
    edge = std::clamp(spacing / 2, side / 255, side / 24);
    count = {int(box.sizes().x() / edge) + 1, int(box.sizes().y() / edge) + 1};
    corner = box.center() - edge / 2 * count.cast<double>();
  }
  std::optional<Pixel> pixel_of(const Vector3d& p) const {
    const Pixel pixel(int(std::floor((p.y() - corner.y()) / edge)),
                      int(std::floor((p.x() - corner.x()) / edge)));
    const bool is_over =
        pixel.first >= 0 && pixel.second >= 0 && pixel.first < count.y() && pixel.second < count.x();
    return is_over ? std::optional(pixel) : std::nullopt;
  }
  bool is_within(const FlatLoop& loop, const Pixel& pixel) const {
    return reference::is_within(loop.rim, corner.x() + edge * (pixel.second + 0.5),
                                corner.y() + edge * (pixel.first + 0.5));
  }
};

// How far the hole stands out of the gaps around it: method.md, D.3.
double prominence(const FoundLoop& loop, const Shape& shape, const Positions& points) {
  const double size = shape.area.stableNorm();
  if (!(size > 0) || !std::isfinite(size)) return 0;
  const double width = 2 * size / shape.length;
  const FlatLoop flat(loop, shape);
  const Raster raster(flat, width, loop.spacing);
  const auto distance = [](const Pixel& a, const Pixel& b) {
    return (a.first - b.first) * (a.first - b.first) + (a.second - b.second) * (a.second - b.second);
  };
  // The nearest pixel of a set, the first of equally near ones: ring by ring.
  const auto nearest = [&](const Pixel& at, const auto& among) {
    std::optional<Pixel> best;
    for (int ring = 0; ring < 512 && (!best || ring * ring <= distance(at, *best)); ++ring) {
      for (int row = at.first - ring; row <= at.first + ring; ++row) {
        const bool is_end = std::abs(row - at.first) == ring;
        for (int column = at.second - ring; column <= at.second + ring;
             column += is_end || ring == 0 ? 1 : 2 * ring) {
          const Pixel pixel(row, column);
          if (!among.contains(pixel)) continue;
          if (!best || std::pair(distance(at, pixel), pixel) < std::pair(distance(at, *best), *best))
            best = pixel;
        }
      }
    }
    return *best;
  };
  std::map<Pixel, float> heights;
  for (const Vector3d& p : flat.at) heights[*raster.pixel_of(p)] = float(p.z());
  std::set<Pixel> sampled;
  for (const Vector3d& p : points) {
    if (!p.allFinite()) continue;
    const Vector3d at = flat(p);
    const std::optional<Pixel> pixel = raster.pixel_of(at);
    if (!pixel) continue;
    const double most = raster.is_within(flat, *pixel) ? 0.2 * width : width;
    if (std::abs(at.z() - heights.at(nearest(*pixel, heights))) <= most) sampled.insert(*pixel);
  }
  int deepest = 0;
  std::vector<int> around;
  for (int row = 0; row < raster.count.y(); ++row) {
    for (int column = 0; column < raster.count.x(); ++column) {
      const Pixel pixel(row, column);
      if (raster.is_within(flat, pixel)) {
        deepest = std::max(deepest, distance(pixel, nearest(pixel, sampled)));
      } else if (distance(pixel, nearest(pixel, heights)) <= width * width / (raster.edge * raster.edge)) {
        around.push_back(distance(pixel, nearest(pixel, sampled)));
      }
    }
  }
  if (around.empty()) around.push_back(0);
  std::sort(around.begin(), around.end());
  return (std::sqrt(deepest) + 0.5) / (std::sqrt(around[std::size_t(0.9 * double(around.size()))]) + 0.5);
}

// What lies over an outer curve and beyond it: method.md, D.3.
struct Beyond {
  double goes_on = 0, layers = 0, volume = 0;
};

Beyond beyond_curve(const FoundLoop& loop, const Shape& shape, const Positions& points) {
  const double size = shape.area.stableNorm(), s = loop.spacing;
  if (!(size > 0) || !std::isfinite(size)) return {};
  const FlatLoop flat(loop, shape);
  const std::size_t n = flat.at.size();
  double radius = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    radius = std::max(radius, (loop.places[i] - shape.centroid).norm());
    squares += flat.at[i].z() * flat.at[i].z();
  }
  int beyond = 0, level = 0, over = 0, far = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d along = flat.at[(i + 1) % n] - flat.at[(i + n - 1) % n];
    Eigen::Vector2d outward(along.y(), -along.x());
    if (outward.norm() > 0) outward.normalize();
    const Vector3d inward = flat(loop.places[i] + loop.offsets[i]) - flat.at[i];
    if (outward.dot(inward.head<2>()) > 0) outward = -outward;
    double height = INFINITY;
    for (const Vector3d& p : points) {
      if (!p.allFinite()) continue;
      const Vector3d d = (flat(p) - flat.at[i]) / s;
      const double out = d.head<2>().dot(outward),
                   aside = std::abs(d.x() * outward.y() - d.y() * outward.x());
      if (out >= 0.7 && out <= 4 && aside <= 1.2 && std::abs(d.z()) <= 2.5)
        height = std::min(height, std::abs(d.z()));
    }
    beyond += height <= 2.5;
    level += height <= 0.5;
  }
  const Raster raster(flat, 0, s);
  std::set<std::array<double, 3>> counted;  // points at one place count once
  for (const Vector3d& p : points) {
    if (!p.allFinite() || !counted.insert({p.x(), p.y(), p.z()}).second) continue;
    const Vector3d at = flat(p);
    const std::optional<Pixel> pixel = raster.pixel_of(at);
    if (!pixel || !raster.is_within(flat, *pixel) || std::abs(at.z()) > radius) continue;
    ++over;
    far += std::abs(at.z()) > std::max(0.12 * radius, 2 * s);
  }
  const auto count = static_cast<double>(n);
  return {.goes_on = level / count,
          .layers = std::sqrt(squares / count) < 0.004 * radius ? beyond / count : 0,
          .volume = over == 0 ? 0 : double(far) / over};
}

// The logarithm of the odds that the loop is true, without what its track adds. `points`: of its level.
double own_log_odds(const FoundLoop& loop, const Positions& points) {
  const Shape shape = shape_of(loop);
  const double width = 2 * shape.area.stableNorm() / shape.length / loop.spacing;
  const double wide = octaves(std::clamp(width, 0.5, 5.)),
               compact = octaves(std::clamp(width / double(loop.places.size()), 1 / 16., 1.)),
               gap = octaves(std::clamp(loop.sampling_gap, 0.25, 1.));
  if (!shape.is_hole) {
    const double rest = 1.5 * loop.surface + 2.3 * wide - 3.1 * gap - 6;
    // What lies beyond could only make it less probable.
    if (rest + 2 <= 0) return rest;
    const Beyond beyond = beyond_curve(loop, shape, points);
    return rest - 3.5 * beyond.goes_on - 2.4 * beyond.layers - 2.6 * beyond.volume;
  }
  const double rest = 9.3 * loop.surface + 3.1 * wide + 1.4 * compact - 7.4 * gap - 16.4;
  // Another one could not make the loop probable.
  if (rest + 1.4 * octaves(32) + 0.7 * 2 <= 0) return rest;
  return rest + 1.4 * octaves(std::clamp(prominence(loop, shape, points), 1., 32.));
}

// How many of these outer curves are near another one, and half to twice as large.
int count_alike(const FoundLoop& loop, const std::vector<const FoundLoop*>& others) {
  const auto size_of = [](const FoundLoop& of) {
    const Vector3d middle = shape_of(of).centroid;
    double radius = 0;
    for (const Vector3d& p : of.places) radius = std::max(radius, (p - middle).norm());
    return std::pair(middle, radius);
  };
  const auto [middle, radius] = size_of(loop);
  int count = 0;
  for (const FoundLoop* other : others) {
    const auto [its_middle, its_radius] = size_of(*other);
    count += other != &loop && (its_middle - middle).norm() < 12 * radius && its_radius >= radius / 2 &&
             its_radius <= 2 * radius;
  }
  return count;
}

struct Tracked {
  std::vector<FoundLoop> loops;  // those that stand
  std::vector<double> confidences;
  std::set<std::size_t> chosen;  // of the loops as they are given, which also have these
  std::vector<double> odds, ranks;
};

// `edges`, and the edges of the lattices on which loops are compared: by level.
Tracked track(const Loops& loops, const std::vector<double>& edges, const std::vector<double>& cells) {
  const std::size_t count = loops.size();
  std::vector<std::vector<float>> near(count,
                                       std::vector<float>(count, 0));  // share of the first, near the second
  std::vector<bool> has_chance, is_hole;
  for (const FoundLoop& loop : loops) {
    is_hole.push_back(shape_of(loop).is_hole);
    has_chance.push_back(loop.log_odds + 2 * (is_hole.back() ? 0.7 : 1) > -4);
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      if (!has_chance[a] || !has_chance[b]) continue;
      const std::size_t coarse = std::max(loops[a].level, loops[b].level);
      if (coarse - std::min(loops[a].level, loops[b].level) > 2) continue;
      const std::set<LatticeCell> of_a = drawn(loops[a], cells[coarse]),
                                  of_b = drawn(loops[b], cells[coarse]);
      near[a][b] = share_near(of_a, of_b);
      near[b][a] = share_near(of_b, of_a);
    }
  }
  const auto is_same = [&](std::size_t a, std::size_t b) { return near[a][b] >= 0.7f && near[b][a] >= 0.7f; };
  std::vector<std::size_t> last(count);
  std::vector<double> odds(count), ranks(count);
  for (std::size_t a = count; a-- > 0;) {
    last[a] = loops[a].level;
    for (std::size_t b = a + 1; b < count; ++b)
      if (loops[a].level != loops[b].level && is_same(a, b)) last[a] = std::max(last[a], last[b]);
    const double ratio = edges[last[a]] / loops[a].spacing;
    odds[a] = loops[a].log_odds + (is_hole[a] ? 0.7 : 1) * (ratio > 1 ? std::min(octaves(ratio), 2.) : 0);
    ranks[a] = std::min(odds[a] - (is_hole[a] ? 0 : 0.25 * octaves(1 + 7)), 4.) -
               0.8 * (static_cast<double>(loops[a].level) + 0.5 * double(loops[a].scale == 1));
  }

  // The first level at which loops of its own kind run along it.
  std::vector<std::size_t> first(count);
  for (std::size_t a = 0; a < count; ++a) {
    first[a] = loops[a].level;
    for (std::size_t b = 0; b < a; ++b) {
      const bool is_track = loops[a].level != loops[b].level && is_same(a, b);
      if (is_track && is_hole[a] == is_hole[b]) first[a] = std::min(first[a], first[b]);
    }
  }

  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks[a] > ranks[b]; });
  std::set<std::size_t> chosen, covered;
  for (const std::size_t i : order) {
    if (covered.contains(i)) continue;
    chosen.insert(i);
    std::set<std::size_t> place;  // the loops of the same hole, of which those at the place are covered
    std::vector<std::size_t> ahead = {i};
    while (!ahead.empty()) {
      const std::size_t at = ahead.back();
      ahead.pop_back();
      for (std::size_t other = 0; other < count; ++other) {
        if (other == at || chosen.contains(other) || place.contains(other)) continue;
        if (near[at][other] < 0.5f && near[other][at] < 0.5f) continue;
        if (at != i && is_hole[other] != is_hole[i] && first[other] <= loops[i].level) continue;
        place.insert(other);
        covered.insert(other);
        if (is_same(at, other)) ahead.push_back(other);
      }
    }
  }
  Tracked tracked{.loops = {}, .confidences = {}, .chosen = chosen, .odds = odds, .ranks = ranks};
  std::vector<std::size_t> sorted(chosen.begin(), chosen.end());
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return order_of(loops[a]) < order_of(loops[b]); });
  std::vector<const FoundLoop*> outer;
  for (const std::size_t i : sorted)
    if (!is_hole[i]) outer.push_back(&loops[i]);
  for (const std::size_t i : sorted) {
    const double alike = is_hole[i] ? 0 : octaves(std::min(1 + count_alike(loops[i], outer), 256));
    tracked.loops.push_back(loops[i]);
    tracked.confidences.push_back(1 / (1 + std::exp(-(odds[i] - 0.25 * alike))));
  }
  return tracked;
}

Detection evaluated(const Level& level, const Config& config) {
  Detection result;
  result.points.resize(level.positions.size());
  find_distinct(level.positions, result);
  find_neighbours(level.positions, config.neighbourhood, result);
  for (PointId p : result.distinct)
    evaluate(level.positions, level.normals, config, p, result.points[value(p)]);
  return result;
}

// The median over points, within a step of 64 an octave: as the engine has it.
double median_distance(const Detection& result) {
  LengthBins bins;
  for (const PointId p : result.distinct) {
    const double r = result.points[value(p)].mean_distance;
    if (r > 0 && std::isfinite(r)) ++bins.counts[LengthBins::bin_of(r)];
  }
  return bins.median();
}

void find_rims(Level level, const Config& config, Detection& result) {
  const bool has_levels = !config.scale.every_point && config.scale.resolution == 0;
  Loops loops = loops_of(level, 0, config, result);
  for (FoundLoop& loop : loops) loop.log_odds = own_log_odds(loop, level.positions);
  std::vector<double> edges = {0}, cells = {median_distance(result) / 1.7};
  if (has_levels) {
    Config one_eps = config;  // a length, alike at all levels
    one_eps.neighbourhood.eps = result.eps;
    one_eps.neighbourhood.eps_fraction = 0;
    Detection below = result;
    while (std::optional<Level> above = level_above(level, below)) {
      level = *std::move(above);
      below = evaluated(level, one_eps);
      Loops of_level = loops_of(level, cells.size(), config, below);
      for (FoundLoop& loop : of_level) loop.log_odds = own_log_odds(loop, level.positions);
      loops.insert(loops.end(), of_level.begin(), of_level.end());
      edges.push_back(level.edge);
      cells.push_back(level.edge);
    }
  }
  const Tracked tracked = track(loops, edges, cells);
  std::set<PointId> on_loop;
  for (std::size_t i = 0; i < tracked.loops.size(); ++i) {
    if (tracked.confidences[i] < config.selection.min_confidence) continue;
    const std::vector<PointId>& rim = tracked.loops[i].points;
    result.loops.push_back(rim);
    result.confidences.push_back(tracked.confidences[i]);
    on_loop.insert(rim.begin(), rim.end());
  }
  for (const PointId p : result.distinct) {
    Point& point = result.points[value(p)];
    const bool is_beside = point.probability > config.coherence.threshold && point.gap &&
                           on_loop.contains((*point.gap)[0]) && on_loop.contains((*point.gap)[1]);
    point.boundary = is_beside || on_loop.contains(p);
  }
}

}  // namespace

Detection detect(const std::vector<Vector3d>& positions, const std::vector<Vector3d>& normals,
                 const Config& config) {
  Level level{.edge = 0, .positions = positions, .normals = normals, .names = {}};
  for (std::uint64_t i = 0; i < positions.size(); ++i) level.names.push_back(PointId{i});
  Detection result = evaluated(level, config);
  if (config.normals.orient) orient_normals(positions, result);
  find_coherent(config.coherence, result);
  if (config.loops.method == LoopMethod::kPaper) {
    result.e =
        config.spanning.e > 0 ? config.spanning.e : std::llround(2 * std::sqrt(pi * result.mean_neighbours));
    find_eligible(positions, config.spanning, result);
    result.boundary_edges = result.eligible.size();
    find_loops(span(result), result);
  } else {
    find_rims(std::move(level), config, result);
  }
  for (Point& point : result.points) {
    if (!point.dropped) point = Point(result.points[value(point.representative)]);
  }
  return result;
}

std::vector<std::vector<PointId>> in_report_order(std::vector<std::vector<PointId>> loops) {
  std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) {
    return std::pair(a[0], a.size()) != std::pair(b[0], b.size())
               ? std::pair(a[0], a.size()) < std::pair(b[0], b.size())
               : a < b;
  });
  return loops;
}

}  // namespace lacuna::reference
