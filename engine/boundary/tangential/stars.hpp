// SPDX-License-Identifier: Apache-2.0
// stars: the triangles around each point over which a ball can rest (method.md, C.1). Also how large they may
// be (C.2), and how large the gaps of the sampling are (C.6).
//
// Idea: a ball of radius R touches p with its centre in p's tangent plane and rolls around it. Its way from
// neighbour to neighbour is a convex hull: that of the neighbours inverted at p. How large the balls are
// shows how large the gaps of the sampling are, and so which triangles are surface.
//
// A neighbour at offset d forbids the directions to the centre c in which the ball would contain it: c . d /
// |d|^2 > 1/2. So the convex hull of the points Pi(d / |d|^2) decides for balls of all sizes, Pi being the
// projection into the tangent plane. The vertices of the hull are the neighbours on which a ball can rest, in
// their order around p. At an edge of the hull at distance h from p, the ball that rests on both its ends has
// radius 1 / (2h). The edge is a triangle of p's star if h > 0 and 1 / (2h) <= R.
//
// Source: Boissonnat, Flototto, A coordinate system associated with points scattered on a surface, CAD 2004.
// Weights: Boissonnat, Ghosh, Manifold reconstruction using tangential Delaunay complexes, DCG 2014.
// Cost: for m neighbours and a link of l vertices m l, in batches of points; m log m where rounding decides.
#pragma once

#include "engine/config/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/ids.hpp"
#include "engine/simd/batch.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lacuna::tangential {

// A point of the surface in the form that the stars around it need: its weighted site.
struct alignas(64) Site {
  double position[3];
  double shift[3];   // to the plane through its neighbours: takes noise out
  double closeness;  // 1 / r
  double weight;     // decides ties among points on one circle, alike for all of them
};

Site site_of(const Eigen::Vector3d& position, const Evaluation& evaluation);

// Larger circumradii count as this one, in units of `Sampling::distance`.
inline constexpr double kLargestRadius = 8;

// One vertex of a star's link, and the circumradius of the triangle of the star's point, this vertex and the
// next one around.
template <class Name>
struct LinkVertex {
  Name point;
  float radius;  // in units of `Sampling::distance`
};

// The circumradius bound that a triangle keeps to. Curves are found at both bounds (method.md, C.2 and C.6).
enum class Scale : std::uint8_t {
  kFine,
  kCoarse,  // it keeps to the coarse bound, not to the fine one
  kNone,    // it keeps to neither: it is no triangle of the surface
};
inline constexpr std::array kScales{Scale::kFine, Scale::kCoarse};

// The largest circumradii of triangles, in units of `Sampling::distance`.
struct RadiusBound {
  float fine = 0, coarse = 0;

  float at(Scale scale) const { return scale == Scale::kFine ? fine : coarse; }
  Scale scale_of(float radius) const {
    return radius <= fine ? Scale::kFine : radius <= coarse ? Scale::kCoarse : Scale::kNone;
  }
};

// A star whose link vertices are in counterclockwise order about the normal.
template <class Name>
struct Star {
  std::span<const LinkVertex<Name>> link;
  RadiusBound bound;

  std::size_t size() const { return link.size(); }
  std::size_t next(std::size_t i) const { return i + 1 < link.size() ? i + 1 : 0; }
  // The bound that the triangle beyond link vertex i of a measured star keeps to.
  Scale scale_of(std::size_t i) const { return bound.scale_of(link[i].radius); }
  // Returns the bound of the triangle with a and b, and kNone if the star does not have it.
  Scale scale_of(Name a, Name b) const {
    for (std::size_t i = 0; i < link.size(); ++i) {
      if (link[i].point != a) continue;
      const std::size_t before = i > 0 ? i - 1 : link.size() - 1;
      Scale scale = link[next(i)].point == b ? scale_of(i) : Scale::kNone;
      if (link[before].point == b) scale = std::min(scale, scale_of(before));
      return scale;
    }
    return Scale::kNone;
  }
  // Within the fine bound.
  bool is_triangle(std::size_t i) const { return scale_of(i) == Scale::kFine; }
  bool has_triangle(Name a, Name b) const { return scale_of(a, b) == Scale::kFine; }
};

// ---- How a star is found

// A point whose star is to be found, and its neighbours, by their places among the sites.
struct StarQuery {
  LocalIndex point;
  Eigen::Vector3d normal;
  std::span<const LocalIndex> neighbours;
};

// The link starts at the neighbour that is farthest when inverted. Its vertices are numbers among the
// neighbours. It is empty where the normal is undefined, or the hull has fewer than three vertices.
// Deterministic: the order of the neighbours decides between points in one place.
struct ExactStar {
  std::vector<LinkVertex<LocalIndex>> link;
  double distance = 0;  // `Sampling::distance`
};
ExactStar find_star_exactly(std::span<const Site> sites, const StarQuery& query);

// A batch of points, one in each lane, and their stars: for the kernel (star_batch.cpp).
inline constexpr std::size_t kMostNeighbours = 64;  // of one point

struct StarBatch {
  const Site* sites;  // of all points
  LocalIndex points[kBatchSize];
  const LocalIndex* neighbours[kBatchSize];  // where there are none: of any one point
  std::uint32_t counts[kBatchSize];          // of neighbours; 0: no star
  double normals[3][kBatchSize];             // unit; NaN: no star
};

struct BatchStars {
  static constexpr std::uint32_t kAmbiguous = UINT32_MAX;

  LinkVertex<LocalIndex> links[kMostNeighbours][kBatchSize];  // by their numbers among the neighbours
  std::uint32_t sizes[kBatchSize];  // ambiguous: vertices are so near to a line that rounding decides
  double distances[kBatchSize];     // `Sampling::distance`
};

void find_batch_stars(const StarBatch& batch, BatchStars& stars);

// The link is as in `ExactStar`.
class FoundStar {
 public:
  FoundStar() = default;
  FoundStar(const LinkVertex<LocalIndex>* first, std::size_t stride, std::size_t size, double distance)
      : first_(first), stride_(stride), size_(size), distance_(distance) {}

  std::size_t size() const { return size_; }
  double distance() const { return distance_; }  // `Sampling::distance`
  const LinkVertex<LocalIndex>& operator[](std::size_t i) const { return first_[i * stride_]; }

 private:
  const LinkVertex<LocalIndex>* first_ = nullptr;
  std::size_t stride_ = 1, size_ = 0;
  double distance_ = 0;
};

// Finds the same stars for a batch of points at once. It keeps its memory.
class StarFinder {
 public:
  explicit StarFinder(std::span<const Site> sites) : sites_(sites) {}

  // Calls visit(first, stars) with the stars of queries `first` and the next, up to kBatchSize. query(i)
  // returns query i of `count`. A star does not depend on the other queries.
  template <class Query, class Visit>
  void for_each_batch(std::size_t count, Query&& query, Visit&& visit) {
    lacuna::for_each_batch(count, queries_, query, [&](std::size_t first) {
      find();
      visit(first, std::span<const FoundStar>(stars_).first(queries_.size()));
    });
  }

 private:
  void find();  // the stars of `queries_`

  std::span<const Site> sites_;
  std::vector<StarQuery> queries_;
  BatchStars batch_stars_;
  std::array<ExactStar, kBatchSize> exact_;
  std::array<FoundStar, kBatchSize> stars_;
};

// ---- The bound on its triangles: the median circumradius around the point, and how much they differ
//
// On a grid all circumradii are 0.71 spacings; among points at random there are small and large ones. At a
// hole some are large since the triangles lie in it, so a median over a point's neighbours decides. Triangles
// that certainly lie in a hole are left out, since on strips and islands half of the triangles do.

// How points lie around a point.
struct Sampling {
  double distance = 0;  // harmonic mean of r over the point and its neighbours (strays, which are far from
                        // each other, count little); 0: the point has no star
  double median_radius = 0;  // median circumradius of its triangles that lie among points; 0: there are none
  double spread = 0;         // distance from the median down to the smallest of them
};

// Returns the samplings of found stars, up to kBatchSize at a time. Returns zeros where a link is empty.
std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config);

// A point and its neighbours, by their places among the samplings.
struct PointAndNeighbours {
  LocalIndex point;
  std::span<const LocalIndex> neighbours;
};

// M is the median circumradius of a point and its neighbours, and S is the median of their spreads. Each is
// at most half of the point's mean distance (`most_radius`). The fine bound is 1.5 M + S (`max_radius`), and
// the coarse bound is twice as large (`coarse_bound`). Points without a star, or with large triangles only,
// do not count. Where no point counts, M and S are half of the mean distance. The bounds of a point without a
// star are 0. The class takes a batch of points at once and keeps its memory.
class RadiusBounder {
 public:
  RadiusBounder(std::span<const Sampling> samplings, const TangentialConfig& config)
      : samplings_(samplings), config_(config) {}

  // Calls visit(i, bound) for each of `count` points. surroundings(i) returns the surroundings of point i. A
  // bound does not depend on the other points.
  template <class Around, class Visit>
  void for_each(std::size_t count, Around&& surroundings, Visit&& visit) {
    for_each_batch(count, points_, surroundings, [&](std::size_t first) {
      find();
      for (std::size_t i = 0; i < points_.size(); ++i) visit(first + i, bounds_[i]);
    });
  }

 private:
  void find();  // the bounds of `points_`

  std::span<const Sampling> samplings_;
  TangentialConfig config_;
  std::vector<PointAndNeighbours> points_;
  std::vector<Batch<double>> medians_, spreads_;
  std::array<RadiusBound, kBatchSize> bounds_;
};

// ---- The sampling radius: how large the gaps of the sampling itself are around a point
//
// Nine in ten of the circumradii around a point, within a bound, do not exceed its sampling radius. Triangles
// in a hole do not count. Unlike the median radius, it is large where points come in pairs, lines or
// clusters.

// The smallest circumradii of a star that do not lie in a hole (`hole_radius`), in units of
// `Sampling::distance`. Where a star has fewer, the last ones are infinite.
struct StarRadii {
  static constexpr std::size_t kMost = 8;
  std::array<float, kMost> radii;
};

// `link`: a range of link vertices, in any order.
template <class Link>
StarRadii smallest_radii(const Link& link, const TangentialConfig& config) {
  StarRadii smallest;
  smallest.radii.fill(std::numeric_limits<float>::infinity());
  std::size_t count = 0;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const float radius = link[i].radius;
    if (!(radius <= config.hole_radius)) continue;
    if (count < StarRadii::kMost) {
      smallest.radii[count++] = radius;
    } else if (const auto largest = std::max_element(smallest.radii.begin(), smallest.radii.end());
               radius < *largest) {
      *largest = radius;
    }
  }
  return smallest;
}

// They are in units of `distance`, the star's `Sampling::distance`.
struct ScaledRadii {
  StarRadii star;
  double distance;
};

// The circumradii around a point. It keeps its memory for the next point.
class RadiiAround {
 public:
  // Gathers the circumradii of the stars of a point and its neighbours. radii_of(q): `ScaledRadii`.
  template <class RadiiOf>
  void gather(LocalIndex point, std::span<const LocalIndex> neighbours, RadiiOf&& radii_of) {
    radii_.clear();
    add(radii_of(point));
    for (const LocalIndex q : neighbours) add(radii_of(q));
  }
  // Returns a radius that nine in ten of the circumradii within a bound do not exceed. It is rounded up to a
  // 64th of the bound. Without any circumradius it is the bound. Cost: linear.
  double sampling_radius(double bound) const;

 private:
  static constexpr std::size_t kSteps = 64;

  void add(const ScaledRadii& radii);

  std::vector<double> radii_;
};

// Returns the mean surface share of a point's neighbours, [0, 1]. surface_of(q): `Evaluation::surface_share`.
template <class SurfaceOf>
float surface_around(std::span<const LocalIndex> neighbours, SurfaceOf&& surface_of) {
  float sum = 0;
  for (const LocalIndex q : neighbours) sum += surface_of(q);
  return sum / static_cast<float>(neighbours.size());
}

}  // namespace lacuna::tangential
