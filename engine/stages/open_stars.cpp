#include "engine/stages/open_stars.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace lacuna {

bool operator<(const Claim& a, const Claim& b) {
  return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
}

bool is_claimed(std::span<const Claim> claims, LocalIndex point) {
  const auto claim =
      std::partition_point(claims.begin(), claims.end(), [&](const Claim& c) { return c.to < point; });
  return claim != claims.end() && claim->to == point;
}

OpenStars::OpenStars(const Tile& tile, RowSet& rough, const RowSet& unmeasured, const StoredStars& stars,
                     std::span<const Claim> claims)
    : tile_(tile),
      rough_(rough),
      unmeasured_(unmeasured),
      claims_(claims),
      points_(stars.stars),
      star_of_(tile.points, kNone) {
  for (const StoredStar& star : stars.stars) {
    star_of_[star.owned] = static_cast<std::uint32_t>(stars_.places.size());
    stars_.places.push_back(star.place);
  }
  for (const StoredCorner& corner : stars.corners) {
    stars_.corners.push_back({corner.point, corner.room});
    stars_.agreements.push_back(corner.agreement);
  }
}

void OpenStars::find_rough_points(const std::function<void(Row)>& visit) {
  std::vector<std::uint32_t> undone(points_.size());
  std::iota(undone.begin(), undone.end(), 0U);
  for (bool go_on = true; go_on;) {
    go_on = false;
    std::erase_if(undone, [&](std::uint32_t s) {
      if (!rough_.contains(row(s))) return false;
      go_on |= follow(s, visit);
      const std::span<const StarCorner<Row>> star = std::as_const(stars_)[s];
      return std::all_of(star.begin(), star.end(), [&](const auto& c) { return rough_.contains(c.point); });
    });
  }
}

// Goes along the refused triangles of a rough point's star: true if a corner was found.
bool OpenStars::follow(std::uint32_t s, const std::function<void(Row)>& visit) {
  bool found = false;
  const auto [begin, size] = stars_.places[s];
  for (std::uint32_t c = begin; c < begin + size; ++c) {
    const std::uint32_t next = c + 1 < begin + size ? c + 1 : begin;
    const Row a = stars_.corners[c].point, b = stars_.corners[next].point;
    if ((rough_.contains(a) && rough_.contains(b)) || !is_refused(s, c, next)) continue;
    for (const Row corner : {a, b}) {
      if (!rough_.insert(corner)) continue;
      found = true;
      visit(corner);
    }
  }
  return found;
}

std::vector<Gap> OpenStars::gaps() {
  std::vector<Gap> gaps;
  for (std::size_t s = 0; s < points_.size(); ++s) {
    if (!rough_.contains(row(s))) continue;
    const auto [begin, size] = stars_.places[s];
    for (std::uint32_t c = begin; c < begin + size; ++c) {
      if (!is_refused(s, c, c + 1 < begin + size ? c + 1 : begin)) stars_.agreements[c] = Agreement::kAgreed;
    }
    for_each_gap(stars_[s], std::as_const(stars_).agreements_of(s), [&](Row from, Row to, float room) {
      gaps.push_back({{points_[s].id, row(s)}, from, to, room});
    });
  }
  return gaps;
}

// The triangle that begins at corner a of star s.
bool OpenStars::is_refused(std::size_t s, std::uint32_t a, std::uint32_t b) {
  Agreement& agreement = stars_.agreements[a];
  if (agreement == Agreement::kOpen && (refuses(a, s, b) || refuses(b, s, a)))
    agreement = Agreement::kRefused;
  return agreement == Agreement::kRefused;
}

// The star of a corner is asked for its triangle with the point of star s and the other corner. If it has it,
// it is here, or it has told: the triangle could not be settled before.
bool OpenStars::refuses(std::uint32_t corner, std::size_t s, std::uint32_t other) const {
  const Row point = stars_.corners[corner].point, third = stars_.corners[other].point;
  if (!rough_.contains(point) || unmeasured_.contains(point)) return false;
  if (!tile_.owns(point))
    return !std::binary_search(claims_.begin(), claims_.end(), Claim{points_[s].owned, 0, point, third});
  const std::uint32_t star = star_of_[tile_.local(point)];
  return star == kNone || !has_triangle(stars_[star], row(s), third);
}

}  // namespace lacuna
