#include "engine/boundary/tangential/active_points.hpp"

#include "engine/boundary/tangential/radius_bound.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace lacuna {
namespace {

// So many steps before it is needed, memory is asked for: it is mostly not in the cache.
constexpr std::size_t kAhead = 8;

// Finds the points and measures their stars.
class TileStarFinder {
 public:
  TileStarFinder(const TilePoints& points, const Rows& neighbourhoods,
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
    mark_waiting(is_border);
    std::fill(marks_.begin() + points.owned, marks_.end(), kWanted);
  }

  TileStars find(double threshold) && {
    for (LocalIndex p = points_.owned; p-- > 0;) {
      if (is_seed(evaluations_[p], threshold)) enter(p);
    }
    search();
    // From here on: whatever other tiles may tell.
    is_certain_ = false;
    for (LocalIndex p = points_.owned; p-- > 0;) {
      if (waits(found_.states[p])) entering_.push_back(p);
    }
    search();
    found_.stars.corners.resize(corners_ + kFewCorners);
    return std::move(found_);
  }

 private:
  // What has become of a point.
  enum Mark : std::uint8_t {
    kSeated = 1,  // it has a seat, or is about to
    kWanted = 2,  // its star has been asked for, or is not found here
    kEntered = 4  // it is active or unsure
  };

  // The triangle that begins at a corner of a star, asked for as soon as another point can be.
  struct Watch {
    LocalIndex star;
    std::uint32_t corner;  // of the star
    std::uint32_t next;    // of the same point
  };
  static constexpr std::uint32_t kNone = UINT32_MAX;

  PointState state(LocalIndex p) const { return found_.states[p]; }

  void mark_waiting(std::span<const std::uint8_t> is_border) {
    for (LocalIndex p = 0; p < points_.owned; ++p) {
      if (!is_border[p]) continue;
      found_.states[p] = PointState::kBorder;
      marks_[p] = kWanted;
      for (const LocalIndex q : neighbourhoods_[p]) {
        if (points_.is_owned(q) && !is_border[q]) found_.states[q] = PointState::kBeside;
      }
    }
  }

  // An owned point is found active, or unsure. Its star is asked once it is measured.
  void enter(LocalIndex p) {
    if (is_certain_) found_.is_active[p] = 1;
    if (waits(state(p)) || (marks_[p] & kEntered) != 0) return;
    marks_[p] |= kEntered;
    entering_.push_back(p);
  }

  // Those that were entered last first: what is near them is in the cache.
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
      for (const LocalIndex p : points) follow_watched_triangles(p);
    }
  }

  // Of the points and of all their neighbours: these tell of the sampling.
  void find_stars_around(std::span<const LocalIndex> points) {
    wanted_.clear();
    for (const LocalIndex p : points) {
      want(p);
      for (const LocalIndex q : neighbourhoods_[p]) want(q);
    }
    seat_wanted();
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

  // Wanted points and their neighbours.
  void seat_wanted() {
    list_unseated();
    for (std::size_t i = 0; i < seating_.size(); ++i) {
      if (i + kAhead < seating_.size()) {
        const LocalIndex ahead = seating_[i + kAhead];
        __builtin_prefetch(&evaluations_[ahead]);
        __builtin_prefetch(&evaluations_[ahead].normal);
        __builtin_prefetch(&points_.positions[ahead]);
      }
      const LocalIndex p = seating_[i];
      sites_[p] = site_of(points_.positions[p], points_.ids[p], evaluations_[p]);
    }
  }

  void list_unseated() {
    seating_.clear();
    const auto list = [&](LocalIndex p) {
      if ((marks_[p] & kSeated) != 0) return;
      marks_[p] |= kSeated;
      seating_.push_back(p);
    };
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      if (i + kAhead < wanted_.size()) __builtin_prefetch(neighbourhoods_[wanted_[i + kAhead]].data());
      list(wanted_[i]);
      for (const LocalIndex q : neighbourhoods_[wanted_[i]]) list(q);
    }
  }

  void add(LocalIndex p, const FoundStar& star) {
    Stars<LocalIndex>& stars = found_.stars;
    const std::size_t end = corners_ + star.size();
    if (stars.corners.size() < end + kFewCorners) stars.corners.resize(2 * end + 1024);
    LinkVertex<LocalIndex>* to = stars.corners.data() + corners_;
    for (std::size_t c = 0; c < star.size(); ++c) *to++ = {neighbourhoods_[p][star[c].point], star[c].room};
    stars.places[p] = {corners_, static_cast<std::uint32_t>(star.size())};
    corners_ = static_cast<std::uint32_t>(end);
  }

  void measure(std::span<const LocalIndex> points) {
    std::vector<LocalIndex> measurable;
    for (const LocalIndex p : points) {
      if (waits(state(p))) continue;
      found_.states[p] = is_certain_ ? PointState::kActive : PointState::kMaybeActive;
      measurable.push_back(p);
    }
    const auto surroundings = [&](std::size_t i) {
      return Surroundings{measurable[i], neighbourhoods_[measurable[i]]};
    };
    RadiusBounder(found_.samplings, config_)
        .for_each(measurable.size(), surroundings, [&](std::size_t i, const RadiusBound& size) {
          const LocalIndex p = measurable[i];
          const auto [begin, corners] = found_.stars.places[p];
          for (std::uint32_t c = begin; c < begin + corners; ++c) {
            float& room = found_.stars.corners[c].room;
            room = room_beyond(size, found_.samplings[p], room);
          }
        });
  }

  // The corner's star has its triangle with a and b not, or may yet turn out not to.
  bool may_refuse(LocalIndex corner, LocalIndex a, LocalIndex b) const {
    if (is_measured(state(corner))) return !has_triangle(found_.stars[corner], a, b);
    return waits(state(corner)) && !is_certain_;
  }

  // There is nothing more to enter.
  bool is_known(LocalIndex p) const {
    return (marks_[p] & kEntered) != 0 || (waits(state(p)) && (!is_certain_ || found_.is_active[p]));
  }

  // Corners of triangles in the point's star that are refused.
  void follow_own_triangles(LocalIndex p) {
    if (state(p) == PointState::kBorder) {  // of a star not known: any of them
      for (const LocalIndex q : neighbourhoods_[p]) {
        if (points_.is_owned(q)) enter(q);
      }
      return;
    }
    const auto star = found_.stars[p];
    for (std::size_t i = 0; i < star.size(); ++i) {
      const LocalIndex a = star[i].point, b = star[i + 1 < star.size() ? i + 1 : 0].point;
      if (is_known(a) && is_known(b)) continue;
      if (waits(state(p)) || star[i].room > 0 || may_refuse(a, p, b) || may_refuse(b, p, a)) {
        enter(a);
        enter(b);
      } else {
        watch(a, p, static_cast<std::uint32_t>(i));
        watch(b, p, static_cast<std::uint32_t>(i));
      }
    }
  }

  void watch(LocalIndex p, LocalIndex star, std::uint32_t corner) {
    if (is_measured(state(p))) return;  // it has been asked
    watches_.push_back(
        {star, corner, std::exchange(watches_of_[p], static_cast<std::uint32_t>(watches_.size()))});
  }

  // Corners of triangles in other stars that this one's refuses.
  void follow_watched_triangles(LocalIndex p) {
    for (std::uint32_t i = watches_of_[p]; i != kNone; i = watches_[i].next) {
      const auto [q, corner, next] = watches_[i];
      const auto star = found_.stars[q];
      const LocalIndex a = star[corner].point, b = star[corner + 1 < star.size() ? corner + 1 : 0].point;
      const LocalIndex third = a == p ? b : a;
      if (!is_known(third) && may_refuse(p, q, third)) enter(third);
    }
  }

  const TilePoints& points_;
  const Rows& neighbourhoods_;
  std::span<const Evaluation> evaluations_;
  const TangentialConfig& config_;
  std::unique_ptr<Site[]> sites_;
  std::vector<std::uint8_t> marks_;
  std::vector<Watch> watches_;
  std::vector<std::uint32_t> watches_of_;  // by point, the last one
  std::uint32_t corners_ = 0;              // of all stars so far
  std::vector<LocalIndex> entering_, wanted_, seating_;
  bool is_certain_ = true;  // else what may be counts as well
  TileStars found_;
};

// The triangles that the stars of points [first, last) ask for, to `asked`: returns how many. Without a
// branch: which corner asks cannot be foretold.
std::size_t ask(const TileStars& found, LocalIndex first, LocalIndex last, AskedTriangle* asked) {
  const Stars<LocalIndex>& stars = found.stars;
  const auto asks_before = [&](LocalIndex p, LocalIndex q) {
    return (q < p) & (found.states[q] == PointState::kActive);
  };
  std::size_t count = 0;
  for (LocalIndex p = first; p < last; ++p) {
    const auto [begin, size] = stars.places[p];
    if (size == 0 || found.states[p] != PointState::kActive) continue;
    const LinkVertex<LocalIndex>* a = &stars.corners[begin + size - 1];
    bool is_asked_before = asks_before(p, a->point);
    for (std::uint32_t i = begin; i < begin + size; ++i) {
      const LinkVertex<LocalIndex>* const b = &stars.corners[i];
      const bool is_told_by_b = asks_before(p, b->point);
      asked[count] = {static_cast<std::uint32_t>(a - stars.corners.data()), p, a->point, b->point};
      count += !(is_asked_before | is_told_by_b) & (a->room <= 0);
      a = b;
      is_asked_before = is_told_by_b;
    }
  }
  return count;
}

void agree(TileStars& found) {
  Stars<LocalIndex>& stars = found.stars;
  stars.consistencies.resize(stars.corners.size(), Consistency::kInconsistent);
  const StarTable table{stars.places.data(), stars.corners.data(), found.states.data(),
                        stars.consistencies.data()};
  constexpr LocalIndex kRun = 64;
  const auto points = static_cast<LocalIndex>(stars.size());
  std::vector<AskedTriangle> asked;
  for (LocalIndex first = 0; first < points; first += kRun) {
    const LocalIndex last = std::min(first + kRun, points);
    std::size_t most = 1;
    for (LocalIndex p = first; p < last; ++p) most += stars.places[p].size;
    if (asked.size() < most) asked.resize(2 * most);
    const std::size_t count = ask(found, first, last, asked.data());
    compare_triangles(table, asked.data(), count);
  }
  for (LocalIndex p = 0; p < points; ++p) {
    const PointState state = found.states[p];
    if (state != PointState::kBeside && state != PointState::kMaybeActive) continue;
    const auto star = stars[p];
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (state == PointState::kBeside || star[i].room <= 0) stars.consistencies_of(p)[i] = Consistency::kUndecided;
    }
  }
}

}  // namespace

TileStars find_stars(const TilePoints& points, const Rows& neighbourhoods,
                     std::span<const Evaluation> evaluations, std::span<const std::uint8_t> is_border,
                     double threshold, const TangentialConfig& config) {
  TileStars found = TileStarFinder(points, neighbourhoods, evaluations, is_border, config).find(threshold);
  agree(found);
  return found;
}

}  // namespace lacuna
