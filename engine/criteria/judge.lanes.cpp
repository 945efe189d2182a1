#include "engine/criteria/judge.hpp"

#include "engine/core/sorting_network.hpp"
#include "engine/criteria/angle.hpp"
#include "engine/criteria/halfdisc.hpp"
#include "engine/criteria/shape.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

using Vectors = Vector<Lanes>;
using Surfaces = Surface<Lanes>;
using Gaps = Gap<Lanes>;
using Mask = LaneBits;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kInfinite = __builtin_inf();
constexpr double kUndefined = __builtin_nan("");

// As many points of a bundle as a register holds, from `first` on.
struct Part {
  const Bundle& bundle;
  std::size_t first;

  LACUNA_INLINE Lanes get(const Eight* rows, std::size_t row) const { return load(rows[row].at + first); }
  LACUNA_INLINE void set(Eight* rows, std::size_t row, Lanes value) const {
    store(rows[row].at + first, value);
  }
  LACUNA_INLINE Vectors offset(std::size_t row) const {
    return {get(bundle.x, row), get(bundle.y, row), get(bundle.z, row)};
  }
  // The offset of another row for each point.
  Vectors offset(Lanes rows) const {
    Vectors offsets{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto row = static_cast<std::size_t>(larger(rows[lane], 0.0));
      offsets.x[lane] = bundle.x[row].at[first + lane];
      offsets.y[lane] = bundle.y[row].at[first + lane];
      offsets.z[lane] = bundle.z[row].at[first + lane];
    }
    return offsets;
  }
  LACUNA_INLINE Lanes counts() const { return load(bundle.counts.at + first); }
};

Lanes measure_distances(const Part& part) {
  Lanes sum{};
  for (std::size_t i = 0; i < part.bundle.rows; ++i) {
    const Vectors offset = part.offset(i);
    const Lanes distance = norm(offset);
    part.set(part.bundle.distance, i, distance);
    sum += distance;
  }
  return sum / part.counts();
}

// ---- The plane through the neighbours: mu_p and C_p (4.3, 4.4)

// Sets the mean; returns exp(-d^2 / sigma^2)-weighted covariance as xx, yy, zz and xy, xz, yz, and whether
// the nearest neighbour's weight can be told from nothing.
struct Covariance {
  Vectors diagonal{}, beside{};
  Mask counts_for_something;
};

Covariance weigh(const Part& part, Lanes sigma, Surfaces& surface) {
  const Lanes falloff = -1.0 / (sigma * sigma);
  const Lanes counts = part.counts();
  Covariance c;
  constexpr double kTiny = -600;
  const Vectors nearest = part.offset(std::size_t{0});
  c.counts_for_something = dot(nearest, nearest) * falloff > kTiny;
  Lanes total{};
  Vectors mean{};
  for (std::size_t i = 0; i < part.bundle.rows; ++i) {
    const Vectors offset = part.offset(i);
    const Lanes kernel = exponential(dot(offset, offset) * falloff);
    const Lanes weight = select(counts > static_cast<double>(i), kernel, Lanes{});
    part.set(part.bundle.weight, i, weight);
    total += weight;
    mean = mean + offset * weight;
  }
  mean = mean / total;
  surface.mean_offset = mean;
  for (std::size_t i = 0; i < part.bundle.rows; ++i) {
    const Vectors d = mean - part.offset(i);
    const Vectors weighted = d * part.get(part.bundle.weight, i);
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
  const auto& normals = part.bundle.given_normals;
  const Vectors given{load(normals[0].at + part.first), load(normals[1].at + part.first),
                      load(normals[2].at + part.first)};
  const Mask is_given = given.x == given.x;
  surface.normal = select(is_given, given, surface.normal);
  surface.has_normal |= is_given;
  return is_given;
}

// ---- The largest gap between directions in the tangent plane (4.2)

// A direction as one number: its angle from 8 to 8 + 2 pi, the neighbour's row in the lowest bits. That is
// exact to 2e-13; without a direction: infinite.
constexpr int kRowShift = std::countr_zero(kMostSortedDirections);
constexpr std::int64_t kRowBits = kMostSortedDirections - 1;
constexpr double kOffset = 8;

LACUNA_INLINE Lanes angle_in(Lanes direction) {
  return from_bits(bits(direction) & ~kRowBits);
}
LACUNA_INLINE LaneBits row_in(Lanes direction) {
  return bits(direction) & kRowBits;
}

// Returns how many neighbours of each point have a direction.
Lanes find_directions(const Part& part, Vectors normal, double cos_cone) {
  // Duff et al., Building an Orthonormal Basis, Revisited (2017).
  const Lanes sign = select(normal.z < 0.0, all_lanes(-1.0), all_lanes(1.0));
  const Lanes s = -1.0 / (sign + normal.z), t = normal.x * normal.y * s;
  const Vectors u{1.0 + sign * normal.x * normal.x * s, sign * t, -sign * normal.x};
  const Vectors v{t, sign + normal.y * normal.y * s, -normal.y};

  Lanes used{};
  for (std::size_t i = 0; i < part.bundle.sorted_rows; ++i) {
    const Vectors offset = part.offset(i);
    const Lanes distance = part.get(part.bundle.distance, i);
    const Lanes x = dot(u, offset), y = dot(v, offset);
    const Lanes shortest = kNoDirection * distance;
    const Mask stable =
        (x * x + y * y > shortest * shortest) & (magnitude(dot(normal, offset)) <= cos_cone * distance);
    const Lanes angle = angle_of(y, x);
    const Lanes turned = select(angle < 0.0, angle + kTurn, angle) + kOffset;
    const Lanes direction = from_bits((bits(turned) & ~kRowBits) | static_cast<std::int64_t>(i));
    part.set(part.bundle.direction, i, select(stable, direction, all_lanes(kInfinite)));
    used += select(stable, all_lanes(1.0), Lanes{});
  }
  return used;
}

// visit(turn, from, to) for the turn from each direction to the next, the last to the first. Sorted rows;
// where there is no direction, the turn is negative.
template <class Visit>
LACUNA_INLINE void for_each_turn(const Part& part, Visit&& visit) {
  const Eight* const directions = part.bundle.direction;
  const Lanes first = part.get(directions, 0);
  Lanes here = first;
  for (std::size_t i = 0; i < part.bundle.sorted_rows; ++i) {
    const Lanes next = i + 1 < part.bundle.sorted_rows ? part.get(directions, i + 1) : all_lanes(kInfinite);
    const Mask is_last = next == kInfinite;
    const Lanes to = select(is_last, first, next);
    const Lanes turn = (angle_in(to) - angle_in(here)) + select(is_last, all_lanes(kTurn), Lanes{});
    visit(select(here == kInfinite, all_lanes(-1.0), turn), row_in(here), row_in(to));
    here = next;
  }
}

Gaps largest_gaps(const Part& part, Vectors normal, double cos_cone) {
  Gaps gap;
  gap.used = find_directions(part, normal, cos_cone);
  LACUNA_LANES::sort_columns(part.bundle.direction, part.bundle.sorted_rows, part.bundle.sorted_rows,
                             part.first);
  const auto pair_of = [](LaneBits from, LaneBits to) {
    return from < to ? from << kRowShift | to : to << kRowShift | from;
  };
  Lanes smallest = all_lanes(kTurn), second{};
  LaneBits pair{};
  for_each_turn(part, [&](Lanes turn, LaneBits from, LaneBits to) {
    pair = turn > gap.size ? pair_of(from, to) : pair;
    second = larger(second, smaller(turn, gap.size));
    gap.size = larger(gap.size, turn);
    smallest = select(turn >= 0.0, smaller(smallest, turn), smallest);
  });
  // Of gaps as large as the largest, the one whose pair, nearer neighbour first, comes first.
  if (any(second >= gap.size - kSameDirection)) {
    pair = ~LaneBits{} & INT64_MAX;
    for_each_turn(part, [&](Lanes turn, LaneBits from, LaneBits to) {
      const LaneBits here = pair_of(from, to);
      pair = (turn >= gap.size - kSameDirection) & (here < pair) ? here : pair;
    });
  }
  gap.near = __builtin_convertvector(pair >> kRowShift, Lanes);
  gap.far = __builtin_convertvector(pair & kRowBits, Lanes);
  constexpr double kInDoubt = 1.001 * kSameDirection;
  const Mask too_many = part.counts() > static_cast<double>(kMostSortedDirections);
  const Mask careful = too_many | (gap.used < 2.0) | (smallest <= kInDoubt);
  if (!any(careful)) return gap;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!careful[lane]) continue;
    const double n[3] = {normal.x[lane], normal.y[lane], normal.z[lane]};
    const GapFit fit = largest_gap_carefully(part.bundle, part.first + lane, n, cos_cone);
    gap.size[lane] = fit.size;
    gap.used[lane] = fit.used;
    gap.near[lane] = fit.near;
    gap.far[lane] = fit.far;
  }
  return gap;
}

// At a sharp crease the estimated normal halves the angle between the two faces, and the faces look like a
// boundary; a quarter turn about the crease may show a surface on both sides (4.6).
void turn_at_creases(const Part& part, const JudgeParameters& parameters, Mask estimated, Surfaces& surface) {
  const Lanes before = angle_probability(surface);
  const Mask in_question =
      estimated & surface.has_normal & (before > parameters.crease_threshold) & (surface.gap.near >= 0.0);
  if (!any(in_question)) return;
  const Vectors near = part.offset(surface.gap.near), far = part.offset(surface.gap.far);
  const Vectors crease = in_plane(far, surface.normal) - in_plane(near, surface.normal);
  constexpr double kOnePoint = 1e-12;
  const Mask is_line = norm(crease) > kOnePoint * (norm(near) + norm(far));
  if (!any(in_question & is_line)) return;

  Surfaces turned = surface;
  turned.normal = cross(crease, surface.normal);
  turned.normal = turned.normal / norm(turned.normal);
  turned.normal = select(in_question & is_line, turned.normal, surface.normal);
  turned.gap = largest_gaps(part, turned.normal, parameters.cos_cone);
  const Mask better = in_question & is_line & (angle_probability(turned) < before / 2.0);
  surface.normal = select(better, turned.normal, surface.normal);
  surface.gap.size = select(better, turned.gap.size, surface.gap.size);
  surface.gap.used = select(better, turned.gap.used, surface.gap.used);
  surface.gap.near = select(better, turned.gap.near, surface.gap.near);
  surface.gap.far = select(better, turned.gap.far, surface.gap.far);
}

Gaps only_where(Mask mask, const Gaps& gap) {
  return {select(mask, gap.size, Lanes{}), select(mask, gap.used, Lanes{}),
          select(mask, gap.near, all_lanes(Gaps::kNone)), select(mask, gap.far, all_lanes(Gaps::kNone))};
}

// The nearest multiple of 2^-24, ties to even.
LACUNA_INLINE Lanes round_to_step(Lanes probability) {
  constexpr double kShift = 0x1.8p28;  // adding it leaves 2^-24 in the lowest bit
  return (probability + kShift) - kShift;
}

void judge_part(const Part& part, const JudgeParameters& parameters, Judgements& judgements) {
  Surfaces surface;
  surface.mean_distance = measure_distances(part);
  fit_plane(part, parameters.sigma, surface);
  const Mask given = use_given_normals(part, surface);
  surface.gap = only_where(surface.has_normal, largest_gaps(part, surface.normal, parameters.cos_cone));
  turn_at_creases(part, parameters, ~given, surface);

  const Lanes criteria[3] = {angle_probability(surface), halfdisc_probability(surface),
                             shape_probability(surface)};
  Lanes sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    sum += parameters.shares[i] * criteria[i];
    store(judgements.criteria[i].at + part.first, criteria[i]);
  }
  store(judgements.probability.at + part.first, round_to_step(sum));
  store(judgements.mean_distance.at + part.first, surface.mean_distance);
  const auto store_vectors = [&](Eight* to, Vectors vectors) {
    store(to[0].at + part.first, vectors.x);
    store(to[1].at + part.first, vectors.y);
    store(to[2].at + part.first, vectors.z);
  };
  const Lanes none = all_lanes(kUndefined);
  store_vectors(judgements.mean_offset, surface.mean_offset);
  store_vectors(judgements.normal, select(surface.has_normal, surface.normal, {none, none, none}));
  store(judgements.gap_near.at + part.first, surface.gap.near);
  store(judgements.gap_far.at + part.first, surface.gap.far);
}

}  // namespace

void judge(const Bundle& bundle, const JudgeParameters& parameters, Judgements& judgements) {
  for (std::size_t first = 0; first < kBundle; first += kLanes)
    judge_part({bundle, first}, parameters, judgements);
}

}  // namespace lacuna::LACUNA_LANES
