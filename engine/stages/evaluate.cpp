#include "engine/stages/evaluate.hpp"

#include "engine/core/vector_math.hpp"

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
  Offsets offsets;
  std::vector<double> weights;
  Directions directions;
};

void gather_offsets(const TilePoints& points, LocalIndex p, std::span<const LocalIndex> neighbours,
                    Offsets& offsets) {
  offsets.resize(neighbours.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    offsets.set(i, points.positions[neighbours[i]] - points.positions[p]);
  }
}

double mean_distance(const Offsets& offsets) {
  double sum = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) sum += offsets.distance[i];
  return sum / static_cast<double>(offsets.size());
}

// exp(-d^2 / sigma^2) of every neighbour: in vector arithmetic, or as the standard library has it.
enum class Precision { kVector, kLibrary };

void weigh(const Offsets& offsets, double sigma, Precision precision, std::vector<double>& weights) {
  const std::size_t count = offsets.size();
  if (weights.size() < count) weights.resize(lanes(count));
  const double squared_sigma = sigma * sigma;
  for (std::size_t i = 0; i < count; ++i) weights[i] = -offsets.squared_distance[i] / squared_sigma;
  constexpr double kTiny = -600;  // where even the nearest neighbour's weight is next to nothing
  if (precision == Precision::kVector && weights.front() > kTiny) {
    exp_each(weights.data(), count, weights.data());
  } else {
    for (std::size_t i = 0; i < count; ++i) weights[i] = std::exp(weights[i]);
  }
}

// mu_p - p and C_p (4.3, 4.4).
struct Moments {
  Eigen::Vector3d mean{0, 0, 0};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Moments weighted_moments(const Offsets& offsets, const std::vector<double>& weights) {
  Moments moments;
  double total = 0, x = 0, y = 0, z = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    total += weights[i];
    x += weights[i] * offsets.x[i];
    y += weights[i] * offsets.y[i];
    z += weights[i] * offsets.z[i];
  }
  if (total == 0) return moments;
  moments.mean = Eigen::Vector3d(x, y, z) / total;
  x = moments.mean.x(), y = moments.mean.y(), z = moments.mean.z();
  double xx = 0, yx = 0, yy = 0, zx = 0, zy = 0, zz = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double dx = x - offsets.x[i], dy = y - offsets.y[i], dz = z - offsets.z[i];
    const double wx = weights[i] * dx, wy = weights[i] * dy, wz = weights[i] * dz;
    xx += wx * dx;
    yx += wy * dx;
    yy += wy * dy;
    zx += wz * dx;
    zy += wz * dy;
    zz += wz * dz;
  }
  moments.covariance << xx, yx, zx, yx, yy, zy, zx, zy, zz;
  return moments;
}

// Sets the mean, the eigenvalues and, where there is one, the normal of the surface.
// Differs from the paper: sigma = r_p by default, not r_p / 3, with which only one or two points count.
void fit_plane(double sigma, LocalSurface& surface, Workspace& w) {
  weigh(w.offsets, sigma, Precision::kVector, w.weights);
  Moments moments = weighted_moments(w.offsets, w.weights);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance);

  // Between eigenvalues this near, the closed form loses digits, and the last digits of the weights decide
  // where the normal points: then no digit is given away.
  constexpr double kNear = 1e-3;
  const Eigen::Vector3d values = solver.eigenvalues();
  const double near = kNear * values.sum();
  if (!(values[1] - values[0] > near && values[2] - values[1] > near)) {
    weigh(w.offsets, sigma, Precision::kLibrary, w.weights);
    moments = weighted_moments(w.offsets, w.weights);
    solver.compute(moments.covariance);
  }
  surface.mean_offset = moments.mean;
  surface.eigenvalues = solver.eigenvalues().reverse();
  // No more than rounding noise between the two smallest: no plane fits better than another.
  constexpr double kSameEigenvalue = 1e-12;
  surface.has_normal =
      surface.eigenvalues[1] - surface.eigenvalues[2] > kSameEigenvalue * surface.eigenvalues.sum();
  surface.normal = solver.eigenvectors().col(0);
}

// At a sharp crease the estimated normal halves the angle between the two faces, and the faces look like a
// boundary; a quarter turn about the crease may show a surface on both sides (4.6).
void turn_at_crease(LocalSurface& surface, double threshold, double cos_cone, Workspace& w) {
  const double before = angle_probability(surface);
  if (!(before > threshold) || surface.gap.near == DirectionGap::kNone) return;
  const auto in_plane = [&](std::uint32_t rank) -> Eigen::Vector3d {
    const Eigen::Vector3d offset = w.offsets[rank];
    return offset - surface.normal * surface.normal.dot(offset);
  };
  const Eigen::Vector3d crease = in_plane(surface.gap.far) - in_plane(surface.gap.near);
  constexpr double kOnePoint = 1e-12;
  const double distances = w.offsets.distance[surface.gap.near] + w.offsets.distance[surface.gap.far];
  if (crease.norm() <= kOnePoint * distances) return;

  LocalSurface turned = surface;
  turned.normal = crease.cross(surface.normal).normalized();
  turned.gap = largest_gap(w.offsets, turned.normal, cos_cone, w.directions);
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
    gather_offsets(points, p, neighbours, w.offsets);
    LocalSurface surface{.mean_distance = mean_distance(w.offsets)};
    fit_plane(criteria.sigma * surface.mean_distance, surface, w);
    const bool given = !given_normals.empty() && usable(given_normals[p]);
    if (given) {
      surface.has_normal = true;
      surface.normal = given_normals[p].stableNormalized();
    }
    if (surface.has_normal) {
      surface.gap = largest_gap(w.offsets, surface.normal, cos_cone, w.directions);
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
