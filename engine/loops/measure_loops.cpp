// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/measure_loops.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace lacuna {
namespace {

using Points = std::span<const LoopPoint>;

// Runs of the loop with their boxes, halved down to a few points. Points near along the loop are near in
// space.
class Runs {
 public:
  Runs(Points loop, Scratch& scratch)
      : loop_(loop), scratch_(scratch), runs_(scratch.array<Run>(most_runs(loop.size()))) {
    build(0, loop.size());
  }

  double diameter() {
    compare(0, 0);
    return std::sqrt(best_);
  }

 private:
  static constexpr std::size_t kLeaf = 16;
  struct Run {
    std::array<double, 3> low, high;
    std::size_t first, last;
    std::size_t left, right;  // 0: a leaf

    std::size_t size() const { return last - first; }
  };

  // Leaves hold more than half of what they may.
  static std::size_t most_runs(std::size_t points) { return 4 * points / kLeaf + 2; }

  std::size_t build(std::size_t first, std::size_t last) {
    scratch_.trim();
    const std::size_t index = count_++;
    std::size_t left = 0, right = 0;
    Eigen::AlignedBox3d box;
    if (last - first <= kLeaf) {
      for (std::size_t i = first; i < last; ++i) box.extend(loop_[i].position());
    } else {
      const std::size_t middle = first + (last - first) / 2;
      left = build(first, middle);
      right = build(middle, last);
      for (const std::size_t half : {left, right})
        box.extend(Eigen::AlignedBox3d(corner(runs_[half].low), corner(runs_[half].high)));
    }
    runs_[index] = {{box.min().x(), box.min().y(), box.min().z()},
                    {box.max().x(), box.max().y(), box.max().z()},
                    first,
                    last,
                    left,
                    right};
    return index;
  }

  static Eigen::Vector3d corner(const std::array<double, 3>& of) { return {of[0], of[1], of[2]}; }

  static double bound(const Run& a, const Run& b) {
    const Eigen::Array3d down = corner(a.high) - corner(b.low), up = corner(b.high) - corner(a.low);
    return down.max(up).square().sum();
  }

  void compare(std::size_t i, std::size_t j) {
    scratch_.trim();
    const Run a = runs_[i], b = runs_[j];
    if (bound(a, b) <= best_) return;
    if (a.left == 0 && b.left == 0) {
      for (const LoopPoint& p : loop_.subspan(a.first, a.size())) {
        for (const LoopPoint& q : loop_.subspan(b.first, b.size()))
          best_ = std::max(best_, (p.position() - q.position()).squaredNorm());
      }
      return;
    }
    const bool split_a = b.left == 0 || (a.left != 0 && a.size() >= b.size());
    std::array<std::pair<std::size_t, std::size_t>, 2> halves =
        split_a ? std::array{std::pair{a.left, j}, std::pair{a.right, j}}
                : std::array{std::pair{i, b.left}, std::pair{i, b.right}};
    const auto far = [&](const auto& pair) { return bound(runs_[pair.first], runs_[pair.second]); };
    if (far(halves[0]) < far(halves[1])) std::swap(halves[0], halves[1]);
    for (const auto& [left, right] : halves) compare(left, right);
  }

  Points loop_;
  Scratch& scratch_;
  std::span<Run> runs_;
  std::size_t count_ = 0;
  double best_ = 0;
};

double perimeter(Points loop, Scratch& scratch) {
  double sum = 0;
  for_each_with_neighbours(loop, scratch, [&](const auto&, const auto& at, const auto& after) {
    sum += (after.position() - at.position()).norm();
  });
  return sum;
}

Eigen::Vector3d centroid(Points loop, Scratch& scratch) {
  const Eigen::Vector3d origin = loop[0].position();  // georeferenced: keep the digits
  Eigen::Vector3d sum{0, 0, 0};
  scratch.for_each(loop, [&](const LoopPoint& p) { sum += p.position() - origin; });
  return origin + sum / static_cast<double>(loop.size());
}

// Returns half the sum of cross products (Newell): its length is the area, its direction the normal.
Eigen::Vector3d area_vector(Points loop, const Eigen::Vector3d& centre, Scratch& scratch) {
  Eigen::Vector3d sum{0, 0, 0};
  for_each_with_neighbours(loop, scratch, [&](const auto&, const auto& at, const auto& after) {
    sum += (at.position() - centre).cross(after.position() - centre);
  });
  return sum / 2;
}

double planarity(Points loop, const Eigen::Vector3d& centre, Scratch& scratch) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d d = p.position() - centre;
    covariance += d * d.transpose();
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d extents = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return extents[2] > 0 ? 1 - extents[0] / extents[2] : 0;
}

// Returns the growth of the enclosed area as the points move towards the surface, each by its own offset.
LoopKind kind(Points loop, const Eigen::Vector3d& normal, Scratch& scratch) {
  double growth = 0, most = 0;
  for_each_with_neighbours(loop, scratch, [&](const auto& before, const auto& at, const auto& after) {
    const Eigen::Vector3d along = after.position() - before.position();
    const Eigen::Vector3d surface(at.surface[0], at.surface[1], at.surface[2]);
    growth += surface.dot(along.cross(normal));
    most += surface.norm() * along.norm();
  });
  // The end of a tube is neither inside nor outside of its surface. It counts as a hole, since a user may
  // fill it.
  constexpr double kUndecided = 0.1;
  return growth < -kUndecided * most ? LoopKind::kOuter : LoopKind::kHole;
}

// A cube is wide against the distance of points, so consecutive points are mostly in one cube.
std::uint64_t lattice_cubes(Points loop, double edge, Scratch& scratch) {
  std::vector<std::array<double, 3>> cubes;
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const std::array cube{std::floor(p.x / edge), std::floor(p.y / edge), std::floor(p.z / edge)};
    if (cubes.empty() || cubes.back() != cube) cubes.push_back(cube);
  });
  std::sort(cubes.begin(), cubes.end());
  return static_cast<std::uint64_t>(std::unique(cubes.begin(), cubes.end()) - cubes.begin());
}

double mean_probability(Points loop, Scratch& scratch) {
  double sum = 0;
  scratch.for_each(loop, [&](const LoopPoint& p) { sum += p.probability; });
  return sum / static_cast<double>(loop.size());
}

Scratch in_memory() {
  return Scratch({}, std::numeric_limits<std::uint64_t>::max());
}

// Cubes of 64 mean edges, as a power of two.
double lattice_edge(double mean_edge_length) {
  return std::ldexp(1.0, std::ilogb(64 * mean_edge_length));
}

}  // namespace

LoopShape shape_of(std::span<const LoopPoint> loop, Scratch& scratch) {
  LoopShape shape{.kind = LoopKind::kHole,
                  .perimeter = perimeter(loop, scratch),
                  .area = 0,
                  .centroid = centroid(loop, scratch),
                  .normal = Eigen::Vector3d::Zero()};
  const Eigen::Vector3d area = area_vector(loop, shape.centroid, scratch);
  shape.area = area.stableNorm();
  if (shape.area > 0) shape.normal = area / shape.area;
  shape.kind = kind(loop, shape.normal, scratch);
  Eigen::Index largest = 0;
  shape.normal.cwiseAbs().maxCoeff(&largest);
  if (shape.normal[largest] < 0) shape.normal = -shape.normal;
  return shape;
}

double diameter(std::span<const LoopPoint> loop, Scratch& scratch) {
  return Runs(loop, scratch).diameter();
}

LoopMeasures measure_loop(std::span<const LoopPoint> loop, double lattice_edge, Scratch& scratch) {
  LoopMeasures measures;
  measures.points = loop.size();
  const LoopShape shape = shape_of(loop, scratch);
  measures.kind = shape.kind;
  measures.perimeter = shape.perimeter;
  measures.area = shape.area;
  measures.centroid = shape.centroid;
  measures.normal = shape.normal;
  measures.diameter = diameter(loop, scratch);
  measures.planarity = planarity(loop, measures.centroid, scratch);
  measures.mean_probability = mean_probability(loop, scratch);
  measures.tiles = lattice_cubes(loop, lattice_edge, scratch);
  return measures;
}

double diameter(const Loop& loop) {
  Scratch scratch = in_memory();
  return diameter(std::span(loop), scratch);
}

LoopMeasures measure_loop(const Loop& loop, double lattice_edge) {
  Scratch scratch = in_memory();
  Loop ordered = loop;
  order_by_place(ordered);
  return measure_loop(std::span<const LoopPoint>(ordered), lattice_edge, scratch);
}

MeasuredLoops measure_loops(ChosenLoops loops, std::span<const LoopTrack> tracks, double mean_edge_length,
                            const Spill& spill, const Workers& workers, Phases& phases) {
  Phase phase(phases, "measure", loops.points());
  std::vector<LoopMeasures> measures(loops.size());
  const double edge = lattice_edge(mean_edge_length);
  for_each_loop(loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    measures[i] = measure_loop(loop, edge, scratch);
    measures[i].track = tracks[i];
    phase.advance(loop.size());
  });
  return {std::move(loops), std::move(measures)};
}

std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config) {
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopMeasures& loop = loops[i];
    const bool too_short = loop.perimeter < config.min_perimeter;
    const bool too_small = loop.diameter < config.min_diameter;
    const bool too_few = loop.points < static_cast<std::uint64_t>(config.min_points);
    const bool unwanted = config.holes_only && loop.kind == LoopKind::kOuter;
    if (!too_short && !too_small && !too_few && !unwanted) selected.push_back(i);
  }
  return selected;
}

}  // namespace lacuna
