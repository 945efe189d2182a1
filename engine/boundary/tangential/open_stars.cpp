#include "engine/boundary/tangential/open_stars.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace lacuna {

bool operator<(const RemoteTriangle& a, const RemoteTriangle& b) {
  return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
}

bool has_remote_triangle(std::span<const RemoteTriangle> remote_triangles, LocalIndex point) {
  const auto claim =
      std::partition_point(remote_triangles.begin(), remote_triangles.end(), [&](const RemoteTriangle& c) { return c.to < point; });
  return claim != remote_triangles.end() && claim->to == point;
}

OpenStars::OpenStars(const Tile& tile, RowSet& active, const RowSet& unmeasured, const StoredStars& stars,
                     std::span<const RemoteTriangle> remote_triangles)
    : tile_(tile),
      active_(active),
      unmeasured_(unmeasured),
      remote_triangles_(remote_triangles),
      points_(stars.stars),
      star_of_(tile.points, kNone) {
  for (const StoredStar& star : stars.stars) {
    star_of_[star.owned] = static_cast<std::uint32_t>(stars_.places.size());
    stars_.places.push_back(star.place);
  }
  for (const StoredLinkVertex& corner : stars.corners) {
    stars_.corners.push_back({corner.point, corner.room});
    stars_.consistencies.push_back(corner.consistency);
  }
}

void OpenStars::find_active_points(const std::function<void(Row)>& visit) {
  std::vector<std::uint32_t> undone(points_.size());
  std::iota(undone.begin(), undone.end(), 0U);
  for (bool go_on = true; go_on;) {
    go_on = false;
    std::erase_if(undone, [&](std::uint32_t s) {
      if (!active_.contains(row(s))) return false;
      go_on |= follow(s, visit);
      const std::span<const LinkVertex<Row>> star = std::as_const(stars_)[s];
      return std::all_of(star.begin(), star.end(), [&](const auto& c) { return active_.contains(c.point); });
    });
  }
}

// Goes along the refused triangles of a active point's star: true if a corner was found.
bool OpenStars::follow(std::uint32_t s, const std::function<void(Row)>& visit) {
  bool found = false;
  const auto [begin, size] = stars_.places[s];
  for (std::uint32_t c = begin; c < begin + size; ++c) {
    const std::uint32_t next = c + 1 < begin + size ? c + 1 : begin;
    const Row a = stars_.corners[c].point, b = stars_.corners[next].point;
    if ((active_.contains(a) && active_.contains(b)) || !is_refused(s, c, next)) continue;
    for (const Row corner : {a, b}) {
      if (!active_.insert(corner)) continue;
      found = true;
      visit(corner);
    }
  }
  return found;
}

std::vector<Wedge> OpenStars::wedges() {
  std::vector<Wedge> wedges;
  for (std::size_t s = 0; s < points_.size(); ++s) {
    if (!active_.contains(row(s))) continue;
    const auto [begin, size] = stars_.places[s];
    for (std::uint32_t c = begin; c < begin + size; ++c) {
      if (!is_refused(s, c, c + 1 < begin + size ? c + 1 : begin)) stars_.consistencies[c] = Consistency::kConsistent;
    }
    for_each_wedge(stars_[s], std::as_const(stars_).consistencies_of(s), [&](Row from, Row to, float room) {
      wedges.push_back({{points_[s].id, row(s)}, from, to, room});
    });
  }
  return wedges;
}

// The triangle that begins at corner a of star s.
bool OpenStars::is_refused(std::size_t s, std::uint32_t a, std::uint32_t b) {
  Consistency& consistency = stars_.consistencies[a];
  if (consistency == Consistency::kUndecided && (refuses(a, s, b) || refuses(b, s, a)))
    consistency = Consistency::kInconsistent;
  return consistency == Consistency::kInconsistent;
}

// The star of a corner is asked for its triangle with the point of star s and the other corner. If it has it,
// it is here, or it has told: the triangle could not be settled before.
bool OpenStars::refuses(std::uint32_t corner, std::size_t s, std::uint32_t other) const {
  const Row point = stars_.corners[corner].point, third = stars_.corners[other].point;
  if (!active_.contains(point) || unmeasured_.contains(point)) return false;
  if (!tile_.owns(point))
    return !std::binary_search(remote_triangles_.begin(), remote_triangles_.end(), RemoteTriangle{points_[s].owned, 0, point, third});
  const std::uint32_t star = star_of_[tile_.local(point)];
  return star == kNone || !has_triangle(stars_[star], row(s), third);
}

}  // namespace lacuna
