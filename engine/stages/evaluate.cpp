#include "engine/stages/evaluate.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace lacuna {
namespace {

struct Weights {
  std::array<double, kCriteria> share;  // sum to 1
};

Weights normalised_weights(const CriteriaConfig& config) {
  double sum = 0;
  for (const Criterion& criterion : kCriteriaTable) sum += config.*criterion.weight;
  Weights weights;
  for (std::size_t i = 0; i < kCriteria; ++i) weights.share[i] = config.*kCriteriaTable[i].weight / sum;
  return weights;
}

// Working space of one thread, used again from point to point.
struct Workspace {
  std::vector<Eigen::Vector3d> offsets;
  std::vector<double> squared_distances, distances, weights;
  std::vector<Direction> directions;
};

void gather_offsets(const TilePoints& points, LocalIndex p, std::span<const LocalIndex> neighbours,
                    Workspace& w) {
  w.offsets.clear();
  w.squared_distances.clear();
  w.distances.clear();
  for (const LocalIndex q : neighbours) {
    w.offsets.push_back(points.positions[q] - points.positions[p]);
    w.squared_distances.push_back(squared_distance(points.positions[q], points.positions[p]));
    w.distances.push_back(std::sqrt(w.squared_distances.back()));
  }
}

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// mu_p and the eigenvectors of C_p (4.3, 4.4), with weights exp(-d^2 / sigma^2).
// Differs from the paper: sigma = r_p by default, not r_p / 3, with which only one or two points count.
struct Moments {
  Eigen::Vector3d mean{0, 0, 0};
  Eigen::Vector3d eigenvalues{0, 0, 0};  // largest first
  Eigen::Vector3d smallest_axis{0, 0, 1};
  bool plane = false;  // the two smallest eigenvalues differ
};

Moments weighted_moments(double sigma, Workspace& w) {
  Moments moments;
  double total = 0;
  w.weights.clear();
  for (std::size_t i = 0; i < w.offsets.size(); ++i) {
    w.weights.push_back(std::exp(-w.squared_distances[i] / (sigma * sigma)));
    total += w.weights[i];
    moments.mean += w.weights[i] * w.offsets[i];
  }
  if (total == 0) {
    moments.mean.setZero();
    return moments;
  }
  moments.mean /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < w.offsets.size(); ++i) {
    const Eigen::Vector3d d = moments.mean - w.offsets[i];
    covariance.noalias() += w.weights[i] * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  moments.eigenvalues = solver.eigenvalues().reverse();
  moments.smallest_axis = solver.eigenvectors().col(0);
  // No more than rounding noise between them: no plane fits better than another.
  constexpr double kSameEigenvalue = 1e-12;
  moments.plane =
      moments.eigenvalues[1] - moments.eigenvalues[2] > kSameEigenvalue * moments.eigenvalues.sum();
  return moments;
}

// At a sharp crease the estimated normal halves the angle between the two faces, and the faces look like a
// boundary; a quarter turn about the crease may show a surface on both sides (4.6).
void turn_at_crease(LocalSurface& surface, double threshold, double cos_cone, Workspace& w) {
  const double before = angle_probability(surface);
  if (!(before > threshold) || surface.gap.near == DirectionGap::kNone) return;
  const auto in_plane = [&](std::uint32_t rank) -> Eigen::Vector3d {
    const Eigen::Vector3d& offset = w.offsets[rank];
    return offset - surface.normal * surface.normal.dot(offset);
  };
  const Eigen::Vector3d crease = in_plane(surface.gap.far) - in_plane(surface.gap.near);
  constexpr double kOnePoint = 1e-12;
  if (crease.norm() <= kOnePoint * (w.distances[surface.gap.near] + w.distances[surface.gap.far])) return;

  LocalSurface turned = surface;
  turned.normal = crease.cross(surface.normal).normalized();
  turned.gap = largest_gap(w.offsets, w.distances, turned.normal, cos_cone, w.directions);
  if (angle_probability(turned) < before / 2) surface = turned;
}

constexpr double kNoCone = 2.0;  // no direction is that steep

// A point that sees no other.
Evaluation lone_point() {
  Evaluation lone;
  lone.criteria.fill(1.0);
  return lone;
}

bool usable(const Eigen::Vector3d& normal) {
  return normal.allFinite() && normal.cwiseAbs().maxCoeff() > 0;
}

}  // namespace

double round_to_step(double value) {
  return std::nearbyint(value / kProbabilityStep) * kProbabilityStep;
}

std::vector<Evaluation> evaluate(const TilePoints& points, const Rows& neighbourhoods,
                                 std::span<const Eigen::Vector3d> given_normals, const NormalsConfig& normals,
                                 const CriteriaConfig& criteria) {
  const Weights weights = normalised_weights(criteria);
  const double cos_cone = criteria.cone == 0 ? kNoCone : std::cos(criteria.cone * std::numbers::pi / 180);
  std::vector<Evaluation> evaluations(points.owned);
  Workspace w;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    const auto neighbours = neighbourhoods[p];
    if (neighbours.empty()) {
      evaluations[p] = lone_point();
      continue;
    }
    gather_offsets(points, p, neighbours, w);
    LocalSurface surface{.offsets = w.offsets, .distances = w.distances, .mean_distance = mean(w.distances)};
    const Moments moments = weighted_moments(criteria.sigma * surface.mean_distance, w);
    surface.mean_offset = moments.mean;
    surface.eigenvalues = moments.eigenvalues;
    const bool given = !given_normals.empty() && usable(given_normals[p]);
    surface.has_normal = given || moments.plane;
    if (surface.has_normal) {
      surface.normal = given ? given_normals[p].stableNormalized() : moments.smallest_axis;
      surface.gap = largest_gap(w.offsets, w.distances, surface.normal, cos_cone, w.directions);
      if (!given) turn_at_crease(surface, normals.crease_threshold, cos_cone, w);
    }

    Evaluation& result = evaluations[p];
    double sum = 0;
    for (std::size_t i = 0; i < kCriteria; ++i) {
      result.criteria[i] = kCriteriaTable[i].probability(surface);
      sum += weights.share[i] * result.criteria[i];
    }
    result.probability = round_to_step(sum);
    result.mean_distance = surface.mean_distance;
    result.mean_offset = surface.mean_offset;
    if (surface.has_normal) result.normal = surface.normal;
    if (surface.gap.near != DirectionGap::kNone) {
      result.gap_near = neighbours[surface.gap.near];
      result.gap_far = neighbours[surface.gap.far];
    }
  }
  return evaluations;
}

}  // namespace lacuna
