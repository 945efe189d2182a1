// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/criteria/criteria_values.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/criteria/criteria_values.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/criteria/formulas-inl.hpp"
#include "engine/criteria/largest_gaps-inl.hpp"
// clang-format on

#include "engine/criteria/criteria.hpp"

#include <utility>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

HWY_INLINE Vector<V> vectors(double value) {
  return {all<V>(value), all<V>(value), all<V>(value)};
}

// ---- The plane through the neighbours: mu_p and C_p (4.3, 4.4)

// The covariance, weighted by exp(-d^2 / sigma^2), as xx, yy, zz and xy, xz, yz. It also says whether the
// weight of the nearest neighbour is more than 0.
struct Covariance {
  Vector<V> diagonal, off_diagonal;
  Mask counts_for_something;
};

Covariance weigh(const Slice& slice, V sigma, Surface<V>& surface) {
  const NeighbourBatch& batch = slice.batch;
  const V falloff = all<V>(-1) / (sigma * sigma), counts = slice.get(batch.counts);
  constexpr double kTiny = -600;
  Covariance c{vectors(0), vectors(0), slice.get(batch.squared_distance[0]) * falloff > all<V>(kTiny)};
  V total = all<V>(0);
  Vector<V> mean = vectors(0);
  for (std::size_t i = 0; i < batch.ranks; ++i) {
    const V kernel = exponential(slice.get(batch.squared_distance[i]) * falloff);
    const V weight = hn::IfThenElseZero(counts > all<V>(static_cast<double>(i)), kernel);
    slice.set(batch.weight[i], weight);
    total = total + weight;
    mean = mean + slice.offset(i) * weight;
  }
  mean = select(total > all<V>(0), mean / total, vectors(0));
  surface.mean_offset = mean;
  for (std::size_t i = 0; i < batch.ranks; ++i) {
    const Vector<V> d = mean - slice.offset(i), weighted = d * slice.get(batch.weight[i]);
    c.diagonal = c.diagonal + Vector<V>{weighted.x * d.x, weighted.y * d.y, weighted.z * d.z};
    c.off_diagonal = c.off_diagonal + Vector<V>{weighted.y * d.x, weighted.z * d.x, weighted.z * d.y};
  }
  return c;
}

// Finds eigenvalues in closed form, divided by their sum, and the eigenvector of the smallest. Returns false
// where the two smallest are so near each other that digits are lost: these points take an iteration instead.
// Source: Smith, *Eigenvalues of a symmetric 3 x 3 matrix*, 1961.
Mask eigen(const Covariance& c, Surface<V>& surface) {
  const V sum = (c.diagonal.x + c.diagonal.y) + c.diagonal.z;
  const Vector<V> a = c.diagonal / sum, b = c.off_diagonal / sum;

  // With B = A - 1/3, the characteristic polynomial is x^3 - 3 m x - 2 q; x = 2 sqrt(m) cos(phi + 2 pi i /
  // 3).
  const V third = all<V>(1.0 / 3), two = all<V>(2);
  const V x = a.x - third, y = a.y - third, z = a.z - third;
  const V m = (((x * x + y * y) + z * z) + two * dot(b, b)) / all<V>(6);
  const V q = (x * (y * z - b.z * b.z) - b.x * (b.x * z - b.z * b.y) + b.y * (b.x * b.z - y * b.y)) / two;
  const V radius = hn::Sqrt(m);
  const V rest = m * m * m - q * q;
  const V phi = angle_of(hn::Sqrt(hn::Max(rest, all<V>(0))), q) / all<V>(3);
  const auto [sine, cosine] = sine_and_cosine(phi);
  const V wide = radius * cosine, narrow = radius * sine * all<V>(std::numbers::sqrt3);
  surface.eigenvalues = {third + two * wide, third - (wide - narrow), third - (wide + narrow)};

  // Rows of A - lambda are at right angles to the eigenvector: the longest of their products is the safest.
  const V lambda = surface.eigenvalues.z;
  const Vector<V> r0{a.x - lambda, b.x, b.y}, r1{b.x, a.y - lambda, b.z}, r2{b.y, b.z, a.z - lambda};
  Vector<V> best = cross(r0, r1);
  for (const Vector<V>& other : {cross(r0, r2), cross(r1, r2)})
    best = select(dot(other, other) > dot(best, best), other, best);
  surface.normal = best / norm(best);
  constexpr double kNear = 1e-3;
  return surface.eigenvalues.y - surface.eigenvalues.z > all<V>(kNear);
}

// Numbers of the points of a slice, one by one.
using Each = double[kLanes<Doubles>];

// Fits planes where `surface` has no normal.
void fit_ambiguous_planes(const Covariance& c, Surface<V>& surface) {
  constexpr Doubles d;
  const auto store = [&](const Vector<V>& vectors, Each* to) HWY_ATTR {
    hn::StoreU(vectors.x, d, to[0]);
    hn::StoreU(vectors.y, d, to[1]);
    hn::StoreU(vectors.z, d, to[2]);
  };
  const auto load = [&](const Each* from) HWY_ATTR {
    return Vector<V>{hn::LoadU(d, from[0]), hn::LoadU(d, from[1]), hn::LoadU(d, from[2])};
  };
  Each covariances[6], eigenvalues[3], normals[3], is_fitted;
  store(c.diagonal, covariances);
  store(c.off_diagonal, covariances + 3);
  store(surface.eigenvalues, eigenvalues);
  store(surface.normal, normals);
  hn::StoreU(hn::IfThenElseZero(surface.has_normal, all<V>(1)), d, is_fitted);
  for (std::size_t lane = 0; lane < kLanes<Doubles>; ++lane) {
    if (is_fitted[lane] != 0) continue;
    double covariance[6];
    for (std::size_t i = 0; i < 6; ++i) covariance[i] = covariances[i][lane];
    const PlaneFit fit = fit_plane_exactly(covariance);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      eigenvalues[axis][lane] = fit.eigenvalues[axis];
      normals[axis][lane] = fit.normal[axis];
    }
    is_fitted[lane] = fit.has_normal;
  }
  surface.eigenvalues = load(eigenvalues);
  surface.normal = load(normals);
  surface.has_normal = hn::LoadU(d, is_fitted) > all<V>(0);
}

// Sets the mean, the eigenvalues and, where there is one, the normal of the surface.
// Differs from the paper: sigma = r_p by default, not r_p / 3, with which only one or two points count.
void fit_plane(const Slice& slice, double sigma_factor, Surface<V>& surface) {
  const Covariance covariance = weigh(slice, all<V>(sigma_factor) * surface.mean_distance, surface);
  surface.has_normal = hn::And(eigen(covariance, surface), covariance.counts_for_something);
  if (any<V>(hn::Not(surface.has_normal))) fit_ambiguous_planes(covariance, surface);
}

// A given normal takes the place of the estimated one, unless it is off. Returns where it does.
Mask use_given_normals(const Slice& slice, bool uses_normals_off, Surface<V>& surface,
                       CriteriaValues& values) {
  constexpr double kCosine45 = std::numbers::sqrt2 / 2;
  const Vector<V> given = slice.get(slice.batch.given_normals);
  const Mask is_off = hn::And(surface.has_normal, hn::Abs(dot(given, surface.normal)) < all<V>(kCosine45));
  slice.set(values.is_normal_off, hn::IfThenElseZero(is_off, all<V>(1)));
  const Mask is_given = given.x == given.x;
  const Mask is_used = uses_normals_off ? is_given : hn::AndNot(is_off, is_given);
  surface.normal = select(is_used, given, surface.normal);
  surface.has_normal = hn::Or(surface.has_normal, is_used);
  return is_used;
}

// ---- The largest gap between directions in the tangent plane (4.2)

HWY_INLINE Slice slice_of(const NeighbourBatch& batch, std::size_t i) {
  return {batch, i * kLanes<Doubles>};
}

HWY_INLINE Gap<V> gap_of(const Slice& slice, const BatchGaps& gaps) {
  return {slice.get(gaps.size), slice.get(gaps.used), slice.get(gaps.near), slice.get(gaps.far)};
}

// The direction of the crease, where a crease is possible.
struct Crease {
  Mask is_there;
  Vector<V> direction;
};
Crease find_crease(const Slice& slice, double threshold, Mask estimated, const Surface<V>& surface) {
  const Gap<V>& gap = surface.gap;
  const Mask is_steep = angle_probability(surface) > all<V>(threshold);
  Crease crease{hn::And(hn::And(estimated, surface.has_normal), hn::And(is_steep, gap.near >= all<V>(0))),
                vectors(0)};
  if (!any<V>(crease.is_there)) return crease;
  const auto offset = [&](V rank) HWY_ATTR {
    return slice.offset_at(hn::DemoteTo(Slice::Ranks(), hn::Max(rank, all<V>(0))));
  };
  const Vector<V> near = offset(gap.near), far = offset(gap.far);
  crease.direction = in_plane(far, surface.normal) - in_plane(near, surface.normal);
  constexpr double kOnePoint = 1e-12;
  crease.is_there =
      hn::And(crease.is_there, norm(crease.direction) > all<V>(kOnePoint) * (norm(near) + norm(far)));
  return crease;
}

// At a sharp crease the estimated normal halves the angle between the two faces, which then resemble a
// boundary. A quarter turn about the crease may show a surface on both sides (4.6).
void turn_at_creases(const NeighbourBatch& batch, const CriteriaParameters& parameters,
                     const Mask (&estimated)[kSlices], TangentPlanes& planes,
                     Surface<V> (&surfaces)[kSlices]) {
  Mask is_turned[kSlices];
  Vector<V> turned[kSlices];
  bool some = false;
  for (std::size_t i = 0; i < kSlices; ++i) {
    const Slice slice = slice_of(batch, i);
    const Crease crease = find_crease(slice, parameters.crease_threshold, estimated[i], surfaces[i]);
    const Vector<V> normal = cross(crease.direction, surfaces[i].normal);
    is_turned[i] = crease.is_there;
    turned[i] = normal / norm(normal);
    slice.set(planes.normals, select(is_turned[i], turned[i], vectors(kUndefined)));
    some |= any<V>(is_turned[i]);
  }
  if (!some) return;
  BatchGaps gaps;
  find_largest_gaps(batch, planes, gaps);
  for (std::size_t i = 0; i < kSlices; ++i) {
    Surface<V>& surface = surfaces[i];
    const Gap<V> before = surface.gap;
    const V half = angle_probability(surface) / all<V>(2);
    surface.gap = gap_of(slice_of(batch, i), gaps);
    const Mask better = hn::And(is_turned[i], angle_probability(surface) < half);
    surface.normal = select(better, turned[i], surface.normal);
    surface.gap = select(better, surface.gap, before);
  }
}

// Returns the nearest multiple of 2^-24, ties to even.
HWY_INLINE V round_to_step(V probability) {
  const V shift = all<V>(0x1.8p28);  // adding it leaves 2^-24 in the lowest bit
  return (probability + shift) - shift;
}

template <std::size_t... kIndex>
void combine(const Slice& slice, const CriteriaParameters& parameters, const Surface<V>& surface,
             CriteriaValues& values, std::index_sequence<kIndex...>) {
  const V criteria[] = {kTable[kIndex].formula(surface)...};
  V sum = all<V>(0);
  for (std::size_t i = 0; i < kCriteria; ++i) {
    sum = sum + all<V>(parameters.shares[i]) * criteria[i];
    slice.set(values.criteria[i], criteria[i]);
  }
  slice.set(values.probability, round_to_step(sum));
  slice.set(values.mean_distance, surface.mean_distance);
  slice.set(values.mean_offset, surface.mean_offset);
  slice.set(values.normal, select(surface.has_normal, surface.normal, vectors(kUndefined)));
  slice.set(values.surface_share, surface.shape.surface);
  slice.set(values.gap_near, surface.gap.near);
  slice.set(values.gap_far, surface.gap.far);
}

}  // namespace

void evaluate_criteria(const NeighbourBatch& batch, const CriteriaParameters& parameters,
                       CriteriaValues& values) {
  Surface<V> surfaces[kSlices];
  Mask estimated[kSlices];
  TangentPlanes planes;
  planes.cos_cone = parameters.cos_cone;
  for (std::size_t i = 0; i < kSlices; ++i) {
    const Slice slice = slice_of(batch, i);
    Surface<V>& surface = surfaces[i];
    surface.mean_distance = slice.get(batch.mean_distance);
    fit_plane(slice, parameters.sigma, surface);
    estimated[i] = hn::Not(use_given_normals(slice, parameters.uses_normals_off, surface, values));
    slice.set(planes.normals, select(surface.has_normal, surface.normal, vectors(kUndefined)));
  }
  BatchGaps gaps;
  find_largest_gaps(batch, planes, gaps);
  for (std::size_t i = 0; i < kSlices; ++i) surfaces[i].gap = gap_of(slice_of(batch, i), gaps);
  turn_at_creases(batch, parameters, estimated, planes, surfaces);
  for (std::size_t i = 0; i < kSlices; ++i) {
    surfaces[i].shape = shape_shares(surfaces[i]);
    combine(slice_of(batch, i), parameters, surfaces[i], values, std::make_index_sequence<kCriteria>());
  }
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(evaluate_criteria);
void evaluate_criteria(const NeighbourBatch& batch, const CriteriaParameters& parameters,
                       CriteriaValues& values) {
  HWY_DYNAMIC_DISPATCH(evaluate_criteria)(batch, parameters, values);
}

// The names are the same for each target.
static_assert(HWY_NAMESPACE::kCriteria <= kMostCriteria);

const std::vector<Criterion>& criteria() {
  static const std::vector<Criterion> all = [] {
    std::vector<Criterion> criteria;
    for (const HWY_NAMESPACE::CriterionEntry& criterion : HWY_NAMESPACE::kTable) {
      const std::string name = criterion.name;
      criteria.push_back(
          {name, "weight_" + name, "scalar_" + name, criterion.default_weight, criterion.help});
    }
    return criteria;
  }();
  return all;
}

std::vector<double> default_weights() {
  std::vector<double> weights;
  for (const Criterion& criterion : criteria()) weights.push_back(criterion.default_weight);
  return weights;
}

}  // namespace lacuna
#endif
