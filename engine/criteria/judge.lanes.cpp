#include "engine/criteria/judge.hpp"

#include "engine/criteria/angle.hpp"
#include "engine/criteria/halfdisc.hpp"
#include "engine/criteria/largest_gaps.hpp"
#include "engine/criteria/part.hpp"
#include "engine/criteria/shape.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

using Vectors = Vector<Lanes>;
using Surfaces = Surface<Lanes>;
using Gaps = Gap<Lanes>;
using Mask = LaneBits;

constexpr double kUndefined = __builtin_nan("");

// ---- The plane through the neighbours: mu_p and C_p (4.3, 4.4)

// Sets the mean; returns exp(-d^2 / sigma^2)-weighted covariance as xx, yy, zz and xy, xz, yz, and whether
// the nearest neighbour's weight can be told from nothing.
struct Covariance {
  Vectors diagonal{}, beside{};
  Mask counts_for_something;
};

Covariance weigh(const Part& part, Lanes sigma, Surfaces& surface) {
  const Lanes falloff = -1.0 / (sigma * sigma);
  const Lanes counts = part.get(part.bundle.counts);
  Covariance c;
  constexpr double kTiny = -600;
  c.counts_for_something = part.get(part.bundle.squared_distance[0]) * falloff > kTiny;
  Lanes total{};
  Vectors mean{};
  for (std::size_t i = 0; i < part.bundle.rows; ++i) {
    const Vectors offset = part.offset(i);
    const Lanes kernel = exponential(part.get(part.bundle.squared_distance[i]) * falloff);
    const Lanes weight = select(counts > static_cast<double>(i), kernel, Lanes{});
    part.set(part.bundle.weight[i], weight);
    total += weight;
    mean = mean + offset * weight;
  }
  mean = mean / total;
  surface.mean_offset = mean;
  for (std::size_t i = 0; i < part.bundle.rows; ++i) {
    const Vectors d = mean - part.offset(i);
    const Vectors weighted = d * part.get(part.bundle.weight[i]);
    c.diagonal = c.diagonal + Vectors{weighted.x * d.x, weighted.y * d.y, weighted.z * d.z};
    c.beside = c.beside + Vectors{weighted.y * d.x, weighted.z * d.x, weighted.z * d.y};
  }
  return c;
}

// Eigenvalues in closed form, divided by their sum, and the eigenvector of the smallest. False where the two
// smallest are so near each other that digits are lost.
Mask eigen(const Covariance& c, Surfaces& surface) {
  const Lanes sum = (c.diagonal.x + c.diagonal.y) + c.diagonal.z;
  const Vectors a = c.diagonal / sum, b = c.beside / sum;

  // With B = A - 1/3, the characteristic polynomial is x^3 - 3 m x - 2 q; x = 2 sqrt(m) cos(phi + 2 pi i /
  // 3).
  const Lanes third = all_lanes(1.0 / 3);
  const Lanes x = a.x - third, y = a.y - third, z = a.z - third;
  const Lanes m = (((x * x + y * y) + z * z) + 2.0 * dot(b, b)) / 6.0;
  const Lanes q = (x * (y * z - b.z * b.z) - b.x * (b.x * z - b.z * b.y) + b.y * (b.x * b.z - y * b.y)) / 2.0;
  const Lanes radius = root(m);
  const Lanes rest = m * m * m - q * q;
  const Lanes phi = angle_of(root(larger(rest, Lanes{})), q) / 3.0;
  Lanes sine, cosine;
  sine_and_cosine(phi, sine, cosine);
  const Lanes wide = radius * cosine, narrow = radius * sine * std::numbers::sqrt3;
  surface.eigenvalues = {third + 2.0 * wide, third - (wide - narrow), third - (wide + narrow)};

  // Rows of A - lambda are at right angles to the eigenvector: the longest of their products is the safest.
  const Lanes lambda = surface.eigenvalues.z;
  const Vectors r0{a.x - lambda, b.x, b.y}, r1{b.x, a.y - lambda, b.z}, r2{b.y, b.z, a.z - lambda};
  Vectors best = cross(r0, r1);
  const Vectors others[] = {cross(r0, r2), cross(r1, r2)};
  for (const Vectors& other : others) {
    best = select(dot(other, other) > dot(best, best), other, best);
  }
  surface.normal = best / norm(best);
  constexpr double kNear = 1e-3;
  return surface.eigenvalues.y - surface.eigenvalues.z > kNear;
}

// Sets the mean, the eigenvalues and, where there is one, the normal of the surface.
// Differs from the paper: sigma = r_p by default, not r_p / 3, with which only one or two points count.
void fit_plane(const Part& part, double sigma_factor, Surfaces& surface) {
  const Lanes sigma = sigma_factor * surface.mean_distance;
  const Covariance covariance = weigh(part, sigma, surface);
  surface.has_normal = eigen(covariance, surface) & covariance.counts_for_something;
  if (!any(~surface.has_normal)) return;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (surface.has_normal[lane]) continue;
    const PlaneFit fit = fit_plane_carefully(part.bundle, part.first + lane, sigma[lane]);
    surface.mean_offset.x[lane] = fit.mean_offset[0];
    surface.mean_offset.y[lane] = fit.mean_offset[1];
    surface.mean_offset.z[lane] = fit.mean_offset[2];
    surface.eigenvalues.x[lane] = fit.eigenvalues[0];
    surface.eigenvalues.y[lane] = fit.eigenvalues[1];
    surface.eigenvalues.z[lane] = fit.eigenvalues[2];
    surface.normal.x[lane] = fit.normal[0];
    surface.normal.y[lane] = fit.normal[1];
    surface.normal.z[lane] = fit.normal[2];
    surface.has_normal[lane] = fit.has_normal ? -1 : 0;
  }
}

// A given normal stands. Returns where there is one.
Mask use_given_normals(const Part& part, Surfaces& surface) {
  const Vectors given = part.get(part.bundle.given_normals);
  const Mask is_given = given.x == given.x;
  surface.normal = select(is_given, given, surface.normal);
  surface.has_normal |= is_given;
  return is_given;
}

// ---- The largest gap between directions in the tangent plane (4.2)

void set_normals(const Part& part, Mask has_normal, Vectors normal, TangentPlanes& planes) {
  const Lanes none = all_lanes(kUndefined);
  part.set(planes.normals, select(has_normal, normal, {none, none, none}));
}

struct GapsByPart {
  Gaps of[kParts];
};
GapsByPart find_gaps(const Bundle& bundle, const TangentPlanes& planes) {
  BundledGaps found;
  LACUNA_LANES::find_largest_gaps(bundle, planes, found);
  GapsByPart gaps;
  for (std::size_t i = 0; i < kParts; ++i) {
    const Part part{bundle, i * kLanes};
    gaps.of[i] = {part.get(found.size), part.get(found.used), part.get(found.near), part.get(found.far)};
  }
  return gaps;
}

// The direction of the crease, if it is in question whether there is one.
struct Crease {
  Mask is_there;
  Vectors direction;
};
Crease find_crease(const Part& part, double threshold, Mask estimated, const Surfaces& surface) {
  Crease crease{
      estimated & surface.has_normal & (angle_probability(surface) > threshold) & (surface.gap.near >= 0.0),
      {}};
  if (!any(crease.is_there)) return crease;
  const Vectors near = part.offset_in_rows(surface.gap.near), far = part.offset_in_rows(surface.gap.far);
  crease.direction = in_plane(far, surface.normal) - in_plane(near, surface.normal);
  constexpr double kOnePoint = 1e-12;
  crease.is_there &= norm(crease.direction) > kOnePoint * (norm(near) + norm(far));
  return crease;
}

// At a sharp crease the estimated normal halves the angle between the two faces, and the faces look like a
// boundary; a quarter turn about the crease may show a surface on both sides (4.6).
void turn_at_creases(const Bundle& bundle, const JudgeParameters& parameters, const Mask (&estimated)[kParts],
                     TangentPlanes& planes, Surfaces (&surfaces)[kParts]) {
  Mask is_turned[kParts], some{};
  Vectors turned[kParts];
  for (std::size_t i = 0; i < kParts; ++i) {
    const Part part{bundle, i * kLanes};
    const Crease crease = find_crease(part, parameters.crease_threshold, estimated[i], surfaces[i]);
    const Vectors normal = cross(crease.direction, surfaces[i].normal);
    is_turned[i] = crease.is_there;
    turned[i] = normal / norm(normal);
    set_normals(part, is_turned[i], turned[i], planes);
    some |= is_turned[i];
  }
  if (!any(some)) return;
  const GapsByPart gaps = find_gaps(bundle, planes);
  for (std::size_t i = 0; i < kParts; ++i) {
    Surfaces& surface = surfaces[i];
    const Gaps before = surface.gap;
    const Lanes probability = angle_probability(surface);
    surface.gap = gaps.of[i];
    const Mask better = is_turned[i] & (angle_probability(surface) < probability / 2.0);
    surface.normal = select(better, turned[i], surface.normal);
    surface.gap = select(better, surface.gap, before);
  }
}

// The nearest multiple of 2^-24, ties to even.
LACUNA_INLINE Lanes round_to_step(Lanes probability) {
  constexpr double kShift = 0x1.8p28;  // adding it leaves 2^-24 in the lowest bit
  return (probability + kShift) - kShift;
}

void combine(const Part& part, const JudgeParameters& parameters, const Surfaces& surface,
             Judgements& judgements) {
  const Lanes criteria[3] = {angle_probability(surface), halfdisc_probability(surface),
                             shape_probability(surface)};
  Lanes sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    sum += parameters.shares[i] * criteria[i];
    part.set(judgements.criteria[i], criteria[i]);
  }
  part.set(judgements.probability, round_to_step(sum));
  part.set(judgements.mean_distance, surface.mean_distance);
  part.set(judgements.mean_offset, surface.mean_offset);
  const Lanes none = all_lanes(kUndefined);
  part.set(judgements.normal, select(surface.has_normal, surface.normal, {none, none, none}));
  part.set(judgements.gap_near, surface.gap.near);
  part.set(judgements.gap_far, surface.gap.far);
}

}  // namespace

void judge(const Bundle& bundle, const JudgeParameters& parameters, Judgements& judgements) {
  Surfaces surfaces[kParts];
  Mask estimated[kParts];
  TangentPlanes planes;
  planes.cos_cone = parameters.cos_cone;
  for (std::size_t i = 0; i < kParts; ++i) {
    const Part part{bundle, i * kLanes};
    surfaces[i].mean_distance = part.get(bundle.mean_distance);
    fit_plane(part, parameters.sigma, surfaces[i]);
    estimated[i] = ~use_given_normals(part, surfaces[i]);
    set_normals(part, surfaces[i].has_normal, surfaces[i].normal, planes);
  }
  const GapsByPart gaps = find_gaps(bundle, planes);
  for (std::size_t i = 0; i < kParts; ++i) surfaces[i].gap = gaps.of[i];
  turn_at_creases(bundle, parameters, estimated, planes, surfaces);
  for (std::size_t i = 0; i < kParts; ++i) combine({bundle, i * kLanes}, parameters, surfaces[i], judgements);
}

}  // namespace lacuna::LACUNA_LANES
