// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/growth.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna::tangential {

bool has_remote_triangle(std::span<const RemoteTriangle> remote_triangles, LocalIndex point) {
  const auto at = std::partition_point(remote_triangles.begin(), remote_triangles.end(),
                                       [&](const RemoteTriangle& triangle) { return triangle.to < point; });
  return at != remote_triangles.end() && at->to == point;
}

Growth::Growth(const Tiling& tiling, TileIndex tile, std::span<const std::uint8_t> is_measured,
               RowSet& active, const OpenStars& open, std::span<const RemoteTriangle> remote_triangles)
    : tiling_(tiling),
      tile_(tiling.tiles[tile]),
      is_measured_(is_measured),
      active_(active),
      remote_triangles_(remote_triangles),
      points_(open.stars),
      vertices_(open.vertices),
      star_of_(tile_.points, kNone) {
  stars_.places.reserve(open.stars.size());
  stars_.vertices.reserve(open.vertices.size());
  stars_.consistencies.reserve(open.vertices.size());
  for (const OpenStar& star : open.stars) {
    star_of_[star.owned] = static_cast<std::uint32_t>(stars_.places.size());
    stars_.places.push_back(star.place);
  }
  for (const OpenLinkVertex& vertex : open.vertices) {
    stars_.vertices.push_back({vertex.row, vertex.radius});
    stars_.consistencies.push_back(vertex.consistency);
  }
}

// Each open star whose point is active is looked at again until all points of its link are active. A star
// leaves the list then: nothing is left that it could make active. Rounds end when no star has found a point.
void Growth::find_active_points(const std::function<void(Row)>& visit) {
  std::vector<std::uint32_t> undone(points_.size());
  std::iota(undone.begin(), undone.end(), 0U);
  for (bool found = true; found;) {
    found = false;
    std::erase_if(undone, [&](std::uint32_t s) {
      if (!active_.contains(row(s))) return false;
      found |= follow(s, visit);
      const auto link = stars_[s].link;
      return std::all_of(link.begin(), link.end(), [&](const auto& v) { return active_.contains(v.point); });
    });
  }
}

// Goes along the inconsistent triangles of an active point's star. Returns true if a point became active.
bool Growth::follow(std::size_t s, const std::function<void(Row)>& visit) {
  bool found = false;
  const Star<Row> star = stars_[s];
  for (std::size_t i = 0; i < star.size(); ++i) {
    const Row a = star.link[i].point, b = star.link[star.next(i)].point;
    if ((active_.contains(a) && active_.contains(b)) || !is_inconsistent(s, i)) continue;
    for (const Row vertex : {a, b}) {
      if (!active_.insert(vertex)) continue;
      found = true;
      visit(vertex);
    }
  }
  return found;
}

std::vector<Wedge> Growth::wedges() {
  std::vector<Wedge> wedges;
  for (std::size_t s = 0; s < points_.size(); ++s) {
    if (!active_.contains(row(s))) continue;
    const Star<Row> star = stars_[s];
    for (std::size_t i = 0; i < star.size(); ++i) scale_of(s, i);
    add_wedges(
        points_[s].point.id, row(s), star, std::span<const Consistency>(stars_.consistencies_of(s)),
        [](Row r) { return r; }, wedges);
  }
  return wedges;
}

CurvePoint Growth::curve_point(const Wedge& wedge, const TangentialConfig& config) const {
  const OpenStar& star = points_[star_of_[tile_.local(wedge.row)]];
  const auto link = vertices_.subspan(star.place.begin, star.place.size);
  const auto length_to = [&](Row end) {
    return std::ranges::find(link, end, [](const OpenLinkVertex& v) { return v.row; })->length;
  };
  const double sampling_radius = star.sampling_radius[static_cast<std::size_t>(wedge.scale)];
  return {star.point,
          {.length = (length_to(wedge.from) + length_to(wedge.to)) / 2,
           .sampling_radius = sampling_radius,
           .distance = star.distance,
           .clearness = clearness(wedge.radius * star.distance, sampling_radius, config),
           .surface = star.surface}};
}

// Returns whether the triangle that begins at link vertex i of star s is inconsistent. Once it is, it stays
// so.
bool Growth::is_inconsistent(std::size_t s, std::size_t i) {
  return !stars_.consistencies_of(s)[i].at(Scale::kFine) || scale_of(s, i) != Scale::kFine;
}

// Returns the scale of that triangle as far as the active points are known. More active points never lower
// the scale.
Scale Growth::scale_of(std::size_t s, std::size_t i) {
  const Star<Row> star = stars_[s];
  const Row a = star.link[i].point, b = star.link[star.next(i)].point;
  Consistency& consistency = stars_.consistencies_of(s)[i];
  if (consistency.is_undecided)
    consistency.scale = std::max({consistency.scale, scale_in(a, s, b), scale_in(b, s, a)});
  return consistency.scale;
}

// Returns the scale of the triangle with the point of star s and a third one, in the star of another point. A
// point that is not active has every triangle. A star that might have an undecided triangle is among the open
// ones, or its tile has sent the triangle.
Scale Growth::scale_in(Row point, std::size_t s, Row third) const {
  if (!active_.contains(point)) return Scale::kFine;
  if (!tile_.owns(point)) {
    if (is_measured_[tiling_.tile_of_row(point)] == 0) return Scale::kFine;
    const RemoteTriangle wanted{points_[s].owned, Scale::kNone, point, third};
    const auto at = std::lower_bound(remote_triangles_.begin(), remote_triangles_.end(), wanted);
    return at != remote_triangles_.end() && !(wanted < *at) ? at->scale : Scale::kNone;
  }
  const std::uint32_t star = star_of_[tile_.local(point)];
  return star == kNone ? Scale::kNone : stars_[star].scale_of(row(s), third);
}

}  // namespace lacuna::tangential
