// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/active_points.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace lacuna::tangential {
namespace {

// Memory is prefetched this many steps before its use: it is mostly not in the cache.
constexpr std::size_t kAhead = 8;

// Finds the points and measures their stars.
class TileStarFinder {
 public:
  TileStarFinder(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                 std::span<const Evaluation> evaluations, std::span<const std::uint8_t> is_border,
                 const TangentialConfig& config)
      : points_(points),
        neighbourhoods_(neighbourhoods),
        evaluations_(evaluations),
        config_(config),
        sites_(std::make_unique_for_overwrite<Site[]>(points.owned)),
        marks_(points.size()),
        watches_of_(points.owned, kNone) {
    found_.states.resize(points.owned, PointState::kInactive);
    found_.is_active.resize(points.owned);
    found_.stars.places.resize(points.owned);
    found_.samplings.resize(points.owned);
    mark_belt(is_border);
    std::fill(marks_.begin() + points.owned, marks_.end(), kWanted);
  }

  TileStars find(std::span<const LocalIndex> seeds) && {
    for (std::size_t i = seeds.size(); i-- > 0;) enter(seeds[i]);
    search();
    // From here on: points that other tiles may make active.
    is_certain_ = false;
    entering_.assign(belt_.rbegin(), belt_.rend());
    search();
    found_.stars.vertices.resize(vertices_ + kFewVertices);
    decide_consistency(found_.stars, found_.states);
    return std::move(found_);
  }

 private:
  // The state of a point in the search.
  enum Mark : std::uint8_t {
    kHasSite = 1,  // it has a site, or is about to
    kWanted = 2,   // its star is found, or about to be, or is not found here
    kEntered = 4   // it is active, or may become so
  };

  // The triangle that begins at a link vertex of a star; to be compared once another point is measured.
  struct Watch {
    LocalIndex star;
    std::uint32_t vertex;  // of its link
    std::uint32_t next;    // of the same point
  };
  static constexpr std::uint32_t kNone = UINT32_MAX;

  PointState state(LocalIndex p) const { return found_.states[p]; }

  void mark_belt(std::span<const std::uint8_t> is_border) {
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!is_border[p]) continue;
      found_.states[p] = PointState::kBorder;
      marks_[p] = kWanted;
      belt_.push_back(p);
      for (const LocalIndex q : neighbourhoods_[p]) {
        if (!points_.is_owned(q) || is_border[q] || found_.states[q] == PointState::kInner) continue;
        found_.states[q] = PointState::kInner;
        belt_.push_back(q);
      }
    }
    std::sort(belt_.begin(), belt_.end());
  }

  // An owned point is active, or may become so.
  void enter(LocalIndex p) {
    if (is_certain_) found_.is_active[p] = 1;
    if (is_in_belt(state(p)) || (marks_[p] & kEntered) != 0) return;
    marks_[p] |= kEntered;
    entering_.push_back(p);
  }

  // The points that were entered last come first: their neighbours are in the cache.
  void search() {
    constexpr std::size_t kAtOnce = 512;
    std::vector<LocalIndex> points;
    while (!entering_.empty()) {
      const std::size_t left = entering_.size() - std::min(entering_.size(), kAtOnce);
      points.assign(entering_.rbegin(), entering_.rend() - static_cast<std::ptrdiff_t>(left));
      entering_.resize(left);
      find_stars_around(points);
      measure(points);
      for (const LocalIndex p : points) follow_own_triangles(p);
      for (const LocalIndex p : points) follow_watches(p);
    }
  }

  // Finds the stars of the points and of all their neighbours: the samplings of these bound the points'
  // triangles.
  void find_stars_around(std::span<const LocalIndex> points) {
    wanted_.clear();
    for (const LocalIndex p : points) {
      want(p);
      for (const LocalIndex q : neighbourhoods_[p]) want(q);
    }
    make_sites();
    const auto query = [&](std::size_t i) {
      return StarQuery{wanted_[i], evaluations_[wanted_[i]].normal, neighbourhoods_[wanted_[i]]};
    };
    StarFinder({sites_.get(), points_.owned})
        .for_each_batch(wanted_.size(), query, [&](std::size_t first, std::span<const FoundStar> batch) {
          const std::array<Sampling, kBatchSize> samplings = samplings_of(batch, config_);
          for (std::size_t i = 0; i < batch.size(); ++i) {
            found_.samplings[wanted_[first + i]] = samplings[i];
            add(wanted_[first + i], batch[i]);
          }
        });
  }

  void want(LocalIndex p) {
    if ((marks_[p] & kWanted) != 0) return;
    marks_[p] |= kWanted;
    wanted_.push_back(p);
  }

  // Makes the sites of wanted points and their neighbours.
  void make_sites() {
    list_without_site();
    for (std::size_t i = 0; i < without_site_.size(); ++i) {
      if (i + kAhead < without_site_.size()) {
        const LocalIndex ahead = without_site_[i + kAhead];
        __builtin_prefetch(&evaluations_[ahead]);
        __builtin_prefetch(&evaluations_[ahead].normal);
        __builtin_prefetch(&points_.positions[ahead]);
      }
      const LocalIndex p = without_site_[i];
      sites_[p] = site_of(points_.positions[p], evaluations_[p]);
    }
  }

  void list_without_site() {
    without_site_.clear();
    const auto list = [&](LocalIndex p) {
      if ((marks_[p] & kHasSite) != 0) return;
      marks_[p] |= kHasSite;
      without_site_.push_back(p);
    };
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      if (i + kAhead < wanted_.size()) __builtin_prefetch(neighbourhoods_[wanted_[i + kAhead]].data());
      list(wanted_[i]);
      for (const LocalIndex q : neighbourhoods_[wanted_[i]]) list(q);
    }
  }

  void add(LocalIndex p, const FoundStar& star) {
    Stars<LocalIndex>& stars = found_.stars;
    const std::size_t end = vertices_ + star.size();
    if (stars.vertices.size() < end + kFewVertices) stars.vertices.resize(2 * end + 1024);
    LinkVertex<LocalIndex>* to = stars.vertices.data() + vertices_;
    for (std::size_t i = 0; i < star.size(); ++i) *to++ = {neighbourhoods_[p][star[i].point], star[i].radius};
    stars.places[p] = {vertices_, static_cast<std::uint32_t>(star.size()), {}};
    vertices_ = static_cast<std::uint32_t>(end);
  }

  void measure(std::span<const LocalIndex> points) {
    std::vector<LocalIndex> measurable;
    for (const LocalIndex p : points) {
      if (is_in_belt(state(p))) continue;
      found_.states[p] = is_certain_ ? PointState::kActive : PointState::kMaybeActive;
      measurable.push_back(p);
    }
    const auto surroundings = [&](std::size_t i) {
      return PointAndNeighbours{measurable[i], neighbourhoods_[measurable[i]]};
    };
    RadiusBounder(found_.samplings, config_)
        .for_each(measurable.size(), surroundings, [&](std::size_t i, const RadiusBound& bound) {
          found_.stars.places[measurable[i]].bound = bound;
        });
  }

  // Returns whether the star of a vertex does not have its triangle with a and b, or may turn out not to have
  // it.
  bool may_lack(LocalIndex vertex, LocalIndex a, LocalIndex b) const {
    if (is_measured(state(vertex))) return !found_.stars[vertex].has_triangle(a, b);
    return is_in_belt(state(vertex)) && !is_certain_;
  }

  // Returns whether nothing is left to enter for the point.
  bool is_known(LocalIndex p) const {
    return (marks_[p] & kEntered) != 0 || (is_in_belt(state(p)) && (!is_certain_ || found_.is_active[p]));
  }

  // Enters the vertices of inconsistent triangles in the point's star.
  void follow_own_triangles(LocalIndex p) {
    if (state(p) == PointState::kBorder) {  // its star is not known: any triangle may be inconsistent
      for (const LocalIndex q : neighbourhoods_[p]) {
        if (points_.is_owned(q)) enter(q);
      }
      return;
    }
    const Star<LocalIndex> star = found_.stars[p];
    for (std::size_t i = 0; i < star.size(); ++i) {
      const LocalIndex a = star.link[i].point, b = star.link[star.next(i)].point;
      if (is_known(a) && is_known(b)) continue;
      if (is_in_belt(state(p)) || !star.is_triangle(i) || may_lack(a, p, b) || may_lack(b, p, a)) {
        enter(a);
        enter(b);
      } else {
        watch(a, p, static_cast<std::uint32_t>(i));
        watch(b, p, static_cast<std::uint32_t>(i));
      }
    }
  }

  void watch(LocalIndex p, LocalIndex star, std::uint32_t vertex) {
    if (is_measured(state(p))) return;  // already compared
    watches_.push_back(
        {star, vertex, std::exchange(watches_of_[p], static_cast<std::uint32_t>(watches_.size()))});
  }

  // Enters the vertices of triangles in other stars that the point's star does not have.
  void follow_watches(LocalIndex p) {
    for (std::uint32_t w = watches_of_[p]; w != kNone; w = watches_[w].next) {
      const auto [q, i, next] = watches_[w];
      const Star<LocalIndex> star = found_.stars[q];
      const LocalIndex a = star.link[i].point, b = star.link[star.next(i)].point;
      const LocalIndex third = a == p ? b : a;
      if (!is_known(third) && may_lack(p, q, third)) enter(third);
    }
  }

  const TilePoints& points_;
  const Neighbourhoods& neighbourhoods_;
  std::span<const Evaluation> evaluations_;
  const TangentialConfig& config_;
  std::unique_ptr<Site[]> sites_;
  std::vector<std::uint8_t> marks_;
  std::vector<Watch> watches_;
  std::vector<std::uint32_t> watches_of_;  // by point, the last one
  std::uint32_t vertices_ = 0;             // of all links so far
  std::vector<LocalIndex> belt_;           // ascending
  std::vector<LocalIndex> entering_, wanted_, without_site_;
  bool is_certain_ = true;  // else points that may become active count as well
  TileStars found_;
};

}  // namespace

TileStars find_stars(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                     std::span<const Evaluation> evaluations, std::span<const LocalIndex> seeds,
                     std::span<const std::uint8_t> is_border, const TangentialConfig& config) {
  return TileStarFinder(points, neighbourhoods, evaluations, is_border, config).find(seeds);
}

}  // namespace lacuna::tangential
