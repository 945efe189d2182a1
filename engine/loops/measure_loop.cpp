#include "engine/loops/measure_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace lacuna {
namespace {

// Runs of the loop with their boxes, halved down to a few points: near along the loop is near in space.
class Runs {
 public:
  explicit Runs(std::span<const LoopPoint> loop) : loop_(loop) { build(0, loop.size()); }

  double diameter() {
    compare(0, 0);
    return std::sqrt(best_);
  }

 private:
  static constexpr std::size_t kLeaf = 8;
  struct Run {
    Eigen::AlignedBox3d box;
    std::size_t first, last;
    std::size_t left = 0, right = 0;
  };

  std::size_t build(std::size_t first, std::size_t last) {
    const std::size_t index = runs_.size();
    runs_.push_back({{}, first, last});
    Eigen::AlignedBox3d box;
    for (std::size_t i = first; i < last; ++i) box.extend(loop_[i].position);
    runs_[index].box = box;
    if (last - first > kLeaf) {
      const std::size_t middle = first + (last - first) / 2;
      const std::size_t left = build(first, middle);
      const std::size_t right = build(middle, last);
      runs_[index].left = left;
      runs_[index].right = right;
    }
    return index;
  }

  static double bound(const Run& a, const Run& b) {
    const Eigen::Array3d down = (a.box.max() - b.box.min()).array(), up = (b.box.max() - a.box.min()).array();
    return down.max(up).square().sum();
  }

  void compare(std::size_t i, std::size_t j) {
    const Run a = runs_[i], b = runs_[j];
    if (bound(a, b) <= best_) return;
    if (a.left == 0 && b.left == 0) {
      for (std::size_t p = a.first; p < a.last; ++p) {
        for (std::size_t q = b.first; q < b.last; ++q) {
          best_ = std::max(best_, (loop_[p].position - loop_[q].position).squaredNorm());
        }
      }
      return;
    }
    const bool split_a = b.left == 0 || (a.left != 0 && a.last - a.first >= b.last - b.first);
    std::array<std::pair<std::size_t, std::size_t>, 2> halves =
        split_a ? std::array{std::pair{a.left, j}, std::pair{a.right, j}}
                : std::array{std::pair{i, b.left}, std::pair{i, b.right}};
    const auto far = [&](const auto& pair) { return bound(runs_[pair.first], runs_[pair.second]); };
    if (far(halves[0]) < far(halves[1])) std::swap(halves[0], halves[1]);
    for (const auto& [left, right] : halves) compare(left, right);
  }

  std::span<const LoopPoint> loop_;
  std::vector<Run> runs_;
  double best_ = 0;
};

const LoopPoint& next(std::span<const LoopPoint> loop, std::size_t i) {
  return loop[(i + 1) % loop.size()];
}
const LoopPoint& previous(std::span<const LoopPoint> loop, std::size_t i) {
  return loop[(i + loop.size() - 1) % loop.size()];
}

double perimeter(std::span<const LoopPoint> loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) sum += (next(loop, i).position - loop[i].position).norm();
  return sum;
}

Eigen::Vector3d centroid(std::span<const LoopPoint> loop) {
  Eigen::Vector3d sum{0, 0, 0};
  for (const LoopPoint& p : loop) sum += p.position - loop[0].position;  // georeferenced: keep the digits
  return loop[0].position + sum / static_cast<double>(loop.size());
}

// Half the sum of cross products (Newell): its length is the area, its direction the normal.
Eigen::Vector3d area_vector(std::span<const LoopPoint> loop, const Eigen::Vector3d& centre) {
  Eigen::Vector3d sum{0, 0, 0};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum += (loop[i].position - centre).cross(next(loop, i).position - centre);
  }
  return sum / 2;
}

double planarity(std::span<const LoopPoint> loop, const Eigen::Vector3d& centre) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const LoopPoint& p : loop) {
    const Eigen::Vector3d d = p.position - centre;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d extents = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return extents[2] > 0 ? 1 - extents[0] / extents[2] : 0;
}

// Growth of the enclosed area as the points move towards the surface, each by its own offset.
LoopKind kind(std::span<const LoopPoint> loop, const Eigen::Vector3d& normal) {
  double growth = 0, most = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d along = next(loop, i).position - previous(loop, i).position;
    const Eigen::Vector3d surface = loop[i].surface.cast<double>();
    growth += surface.dot(along.cross(normal));
    most += surface.norm() * along.norm();
  }
  // The end of a tube is neither inside nor outside of its surface: something to be filled all the same.
  constexpr double kUndecided = 0.1;
  return growth < -kUndecided * most ? LoopKind::kOuter : LoopKind::kHole;
}

std::uint64_t lattice_cubes(std::span<const LoopPoint> loop, double edge) {
  std::vector<std::array<double, 3>> cubes;
  for (const LoopPoint& p : loop) {
    cubes.push_back({std::floor(p.position.x() / edge), std::floor(p.position.y() / edge),
                     std::floor(p.position.z() / edge)});
  }
  std::sort(cubes.begin(), cubes.end());
  return static_cast<std::uint64_t>(std::unique(cubes.begin(), cubes.end()) - cubes.begin());
}

double mean_probability(std::span<const LoopPoint> loop) {
  double sum = 0;
  for (const LoopPoint& p : loop) sum += p.probability;
  return sum / static_cast<double>(loop.size());
}

}  // namespace

double diameter(std::span<const LoopPoint> loop) {
  return Runs(loop).diameter();
}

LoopMeasures measure_loop(std::span<const LoopPoint> loop, double lattice_edge) {
  LoopMeasures measures;
  measures.points = loop.size();
  measures.perimeter = perimeter(loop);
  measures.diameter = diameter(loop);
  measures.centroid = centroid(loop);
  const Eigen::Vector3d area = area_vector(loop, measures.centroid);
  measures.area = area.norm();
  if (measures.area > 0) measures.normal = area / measures.area;
  measures.kind = kind(loop, measures.normal);
  measures.planarity = planarity(loop, measures.centroid);
  measures.mean_probability = mean_probability(loop);
  measures.tiles = lattice_cubes(loop, lattice_edge);
  return measures;
}

}  // namespace lacuna
