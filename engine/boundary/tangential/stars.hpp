// stars: the triangles around each point over which a ball can rest, the rims that they leave, and how much
// room there is beyond a rim.
//
// A ball of radius R touches p with its centre in p's tangent plane and rolls around it. Of all directions
// to the centre, a neighbour at offset d forbids those in which the ball would hold it: with c the centre,
// c . d / |d|^2 > 1/2. So what the ball of any size can do is told by the convex hull of the points
// Pi(d / |d|^2), Pi the projection into the tangent plane. Corners of the hull are the neighbours that a ball
// can rest on, in their order around p; at an edge of the hull at distance h from p the ball that rests on
// both its ends has radius 1 / (2h). With h > 0 and 1 / (2h) <= R the edge is a triangle of p's star; R is
// told by the balls of the stars around (stages/ball_sizes).
//
// A triangle counts only if it is in the stars of all its active corners (stages/tile_stars). Triangles at one
// corner never overlap (they are in one star), so the agreed triangles are a surface with boundary whatever
// the noise: an edge has at most two of them, and around each point wedges and fans of triangles alternate.
// Each end of a wedge is an edge with one triangle, which ends exactly one wedge at its other end, too: the rims
// are closed curves.
#pragma once

#include "engine/criteria/evaluation.hpp"
#include "engine/boundary/tangential/star.hpp"
#include "engine/simd/batch.hpp"
#include "engine/boundary/tangential/star_batch.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

Site site_of(const Eigen::Vector3d& position, PointId id, const Evaluation& evaluation);

// A point whose star is looked for, and its neighbours, by their places among the sites.
struct StarQuery {
  LocalIndex point;
  Eigen::Vector3d normal;
  std::span<const LocalIndex> neighbours;
};

// Corners in counterclockwise order about the normal, from the one that is seen farthest when inverted, by
// their number among the neighbours; none where the normal is undefined or fewer than three directions are
// seen. Deterministic: the order of the neighbours decides between points in one place.
struct ExactStar {
  std::vector<LinkVertex<LocalIndex>> corners;
  double distance = 0;  // `Sampling::distance`
};
ExactStar find_star_exactly(std::span<const Site> sites, const StarQuery& query);

// Corners as above.
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

// Finds the same stars, those of a batch side by side: keeps its memory.
class StarFinder {
 public:
  explicit StarFinder(std::span<const Site> sites) : sites_(sites) {}

  // visit(first, stars): the stars of queries `first` and the next, up to kBatchSize; query(i): the i-th of
  // `count`. What a star is depends on no other query.
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

// Stars of points 0, 1, 2, ...; `consistencies` of the triangles that begin at each corner.
template <class Name>
struct Stars {
  std::vector<StarPlace> places;
  std::vector<LinkVertex<Name>> corners;
  std::vector<Consistency> consistencies;

  std::size_t size() const { return places.size(); }
  std::span<const LinkVertex<Name>> operator[](std::size_t p) const {
    return {corners.data() + places[p].begin, places[p].size};
  }
  std::span<const Consistency> consistencies_of(std::size_t p) const {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
  std::span<Consistency> consistencies_of(std::size_t p) {
    return {consistencies.data() + places[p].begin, places[p].size};
  }
};

// The star has the triangle of its point with a and b.
template <class Name>
bool has_triangle(std::span<const LinkVertex<Name>> star, Name a, Name b) {
  const std::size_t count = star.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (star[i].point != a) continue;
    const auto &next = star[i + 1 < count ? i + 1 : 0], &before = star[i > 0 ? i - 1 : count - 1];
    return (next.point == b && star[i].room <= 0) || (before.point == b && before.room <= 0);
  }
  return false;
}

// visit(from, to, room): each wedge of a star's point between agreed triangles, as in `Wedge`. None where nothing
// is agreed.
template <class Name, class Visit>
void for_each_wedge(std::span<const LinkVertex<Name>> star, std::span<const Consistency> consistencies,
                  Visit&& visit) {
  const std::size_t count = star.size();
  const auto next = [&](std::size_t i) { return i + 1 < count ? i + 1 : 0; };
  for (std::size_t i = 0; i < count; ++i) {
    if (consistencies[i] != Consistency::kConsistent || consistencies[next(i)] == Consistency::kConsistent) continue;
    std::size_t end = next(i);
    float room = 0;
    for (; consistencies[end] != Consistency::kConsistent; end = next(end)) room = std::max(room, star[end].room);
    visit(star[next(i)].point, star[end].point, room);
  }
}

}  // namespace lacuna
