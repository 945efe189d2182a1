// SPDX-License-Identifier: Apache-2.0
// stars: the triangles around each point over which a ball can rest (method.md, C.1).
//
// A ball of radius R touches p with its centre in p's tangent plane and rolls around it. A neighbour at
// offset d forbids the directions to the centre c in which the ball would contain it: c . d / |d|^2 > 1/2. So
// the convex hull of the points Pi(d / |d|^2) decides for balls of all sizes, Pi being the projection into
// the tangent plane. The vertices of the hull are the neighbours on which a ball can rest, in their order
// around p. At an edge of the hull at distance h from p, the ball that rests on both its ends has radius 1 /
// (2h). The edge is a triangle of p's star if h > 0 and 1 / (2h) <= R. The stars around p bound R
// (radius_bound.hpp).
//
// A triangle is consistent if the stars of all its active vertices have it (active_points.hpp). Triangles of
// one star never overlap, so consistent triangles are a surface with boundary whatever the noise. An edge has
// at most two consistent triangles. Around each point, fans of triangles and boundary wedges alternate. Each
// end of a wedge is an edge with one triangle, and ends exactly one wedge at its other end: boundary curves
// are closed.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/boundary/tangential/star_batch.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/simd/batch.hpp"

#include <array>
#include <span>
#include <vector>

namespace lacuna::tangential {

Site site_of(const Eigen::Vector3d& position, const Evaluation& evaluation);

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

// Stars of points 0, 1, 2, ...; `consistencies` has a value for the triangle that begins at each link vertex.
template <class Name>
struct Stars {
  std::vector<StarRange> places;
  std::vector<LinkVertex<Name>> vertices;
  std::vector<Consistency> consistencies;

  std::size_t size() const { return places.size(); }
  Star<Name> operator[](std::size_t p) const {
    return {{vertices.data() + places[p].begin, places[p].size}, places[p].bound};
  }
  std::span<const Consistency> consistencies_of(std::size_t p) const {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
  std::span<Consistency> consistencies_of(std::size_t p) {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
};

}  // namespace lacuna::tangential
