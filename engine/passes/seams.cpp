#include "engine/passes/seams.hpp"

#include "engine/core/merge_runs.hpp"
#include "engine/stages/ball_sizes.hpp"
#include "engine/stages/stars.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace lacuna {
namespace {

// The star of `from` has the triangle (from, to, other); told to the tile of `to`.
struct Claim {
  LocalIndex to;
  std::uint32_t padding = 0;
  Row from, other;

  friend bool operator<(const Claim& a, const Claim& b) {
    return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
  }
};

// One tile's rows.
class Here {
 public:
  Here(const Tiling& tiling, TileIndex tile)
      : first_(value(tiling.tiles[tile].first_row)), points_(tiling.tiles[tile].points) {}

  bool owns(Row row) const { return value(row) - first_ < points_; }
  LocalIndex local(Row row) const { return static_cast<LocalIndex>(value(row) - first_); }
  Row row(LocalIndex owned) const { return Row{first_ + owned}; }
  std::uint64_t points() const { return points_; }

 private:
  std::uint64_t first_, points_;
};

// Records on their way, gathered by the tile that they are for.
template <class Record>
class Letters {
 public:
  void add(TileIndex tile, const Record& record) { letters_[tile].push_back(record); }
  void send(Spill<Record>& post) const {
    for (const auto& [tile, letter] : letters_) post.append(tile, letter);
  }

 private:
  std::map<TileIndex, std::vector<Record>> letters_;
};

// Of a border point; told to its own tile and to those of its neighbours.
struct ToldSampling {
  Row row;
  Sampling sampling;
};

// The points of a tile that wait, and what they see.
struct Waiting {
  struct Point {
    LocalIndex place;  // in sight
    Standing standing;
    Eigen::Vector3d normal;
    std::span<const LocalIndex> neighbours;  // places in sight
  };
  std::vector<SeenPoint> in_sight;
  std::vector<LocalIndex> all_neighbours;
  std::vector<Point> points;

  Waiting(const StarLists& lists, TileIndex t)
      : in_sight(lists.waiting_sight.read(t)), all_neighbours(lists.waiting_neighbours.read(t)) {
    std::span<const LocalIndex> left = all_neighbours;
    for (const WaitingPoint& p : lists.waiting.read(t)) {
      points.push_back(
          {p.place, p.standing, {p.normal[0], p.normal[1], p.normal[2]}, left.first(p.neighbours)});
      left = left.subspan(p.neighbours);
    }
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  Row row(LocalIndex place) const { return in_sight[place].vertex.row; }
};

std::vector<StarQuery> border_points(const Waiting& waiting) {
  std::vector<StarQuery> points;
  for (const Waiting::Point& p : waiting.points) {
    if (p.standing == Standing::kBorder) points.push_back({p.place, p.normal, p.neighbours});
  }
  return points;
}

// Of the points that ask and of their neighbours; none of the others.
std::vector<Seat> read_seats(std::span<const StarQuery> queries, const Waiting& waiting,
                             const Column<Seat>& stored) {
  std::vector<std::uint8_t> is_needed(waiting.in_sight.size());
  for (const StarQuery& query : queries) {
    is_needed[query.point] = 1;
    for (const LocalIndex q : query.neighbours) is_needed[q] = 1;
  }
  // In runs of rows that are near each other. What is farther between them was mostly never written: reading
  // that, too, would fill the system's cache with zeros.
  constexpr std::uint64_t kNear = 64;
  const auto row = [&](std::size_t i) { return value(waiting.row(static_cast<LocalIndex>(i))); };
  std::vector<Seat> seats(waiting.in_sight.size());
  std::vector<Seat> run;
  for (std::size_t i = 0; i < seats.size();) {
    if (!is_needed[i]) {
      ++i;
      continue;
    }
    std::size_t last = i;
    for (std::size_t j = i + 1; j < seats.size() && row(j) <= row(last) + kNear; ++j) {
      if (is_needed[j]) last = j;
    }
    const std::uint64_t first_row = row(i);
    run.resize(row(last) - first_row + 1);
    stored.read(first_row, std::span(run));
    for (; i <= last; ++i) seats[i] = run[row(i) - first_row];
  }
  return seats;
}

void find_border_stars(StarLists& lists, const Tiling& tiling, TileIndex t, Spill<ToldSampling>& post) {
  const Here here(tiling, t);
  const Waiting waiting(lists, t);
  const std::vector<StarQuery> queries = border_points(waiting);
  const std::vector<Seat> seats = read_seats(queries, waiting, lists.seats);

  const auto before = static_cast<std::uint32_t>(lists.open_corners.count(t));
  std::vector<StoredStar> stars;
  std::vector<StoredCorner> corners;
  Letters<ToldSampling> letters;
  std::vector<TileIndex> tiles;
  const auto tell = [&](const StarQuery& query, const FoundStar& star, const Sampling& sampling) {
    const Vertex& point = waiting.in_sight[query.point].vertex;
    const auto begin = before + static_cast<std::uint32_t>(corners.size());
    if (star.size() > 0)
      stars.push_back(
          {point.id, here.local(point.row), {begin, static_cast<std::uint32_t>(star.size())}, kMeasured, 1});
    for (std::size_t c = 0; c < star.size(); ++c)
      corners.push_back({waiting.row(query.neighbours[star[c].point]), star[c].room, Agreement::kOpen});
    tiles.assign(1, t);
    for (const LocalIndex q : query.neighbours) {
      if (!here.owns(waiting.row(q))) tiles.push_back(tiling.tile_of_row(waiting.row(q)));
    }
    std::sort(tiles.begin(), tiles.end());
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    for (const TileIndex tile : tiles) letters.add(tile, {point.row, sampling});
  };
  StarFinder(seats).for_each_bundle(
      queries.size(), [&](std::size_t i) { return queries[i]; },
      [&](std::size_t first, std::span<const FoundStar> bundle) {
        const std::array<Sampling, kEight> samplings = samplings_of(bundle);
        for (std::size_t i = 0; i < bundle.size(); ++i) tell(queries[first + i], bundle[i], samplings[i]);
      });
  lists.open.append(t, stars);
  lists.open_corners.append(t, corners);
  letters.send(post);
}

// Of all points in sight: what their own tile knew, and what border points have told since.
std::vector<Sampling> all_samplings(std::span<const SeenPoint> in_sight, std::vector<ToldSampling> told) {
  std::vector<Sampling> samplings;
  for (const SeenPoint& p : in_sight) samplings.push_back(p.sampling);
  std::sort(told.begin(), told.end(), [](const auto& a, const auto& b) { return a.row < b.row; });
  std::size_t i = 0;
  for (const ToldSampling& news : told) {
    while (in_sight[i].vertex.row < news.row) ++i;
    samplings[i] = news.sampling;
  }
  return samplings;
}

// In ascending owned index: they were stored in runs that are.
std::vector<StoredStar> read_open_stars(const StarLists& lists, TileIndex t) {
  std::vector<StoredStar> stars = lists.open.read(t);
  merge_runs(stars, [](const StoredStar& a, const StoredStar& b) { return a.owned < b.owned; });
  return stars;
}

// A star that waited to be measured.
struct WaitingStar {
  Surroundings seen;  // by their places in sight
  StoredStar* star;
};

// The stars of waiting points, among these and others.
std::vector<WaitingStar> waiting_stars(const Waiting& waiting, const Here& here, std::span<StoredStar> open) {
  std::vector<WaitingStar> stars;
  auto star = open.begin();
  for (const Waiting::Point& p : waiting.points) {
    const LocalIndex owned = here.local(waiting.in_sight[p.place].vertex.row);
    while (star != open.end() && star->owned < owned) ++star;
    if (star != open.end() && star->owned == owned) stars.push_back({{p.place, p.neighbours}, &*star});
  }
  return stars;
}

// As in a measured star.
float room(const StoredStar& star, const StoredCorner& corner) {
  return room_beyond(star.size, {.distance = star.distance}, corner.room);
}

// Tells the tiles of a star's foreign corners of the triangles that it has with them.
void tell_triangles(Row point, const StoredStar& star, std::span<const StoredCorner> corners,
                    const Tiling& tiling, const Here& here, Letters<Claim>& letters) {
  const auto tell = [&](Row to, Row other) {
    if (here.owns(to)) return;
    const TileIndex tile = tiling.tile_of_row(to);
    letters.add(tile, {Here(tiling, tile).local(to), 0, point, other});
  };
  corners = corners.subspan(star.place.begin, star.place.size);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (room(star, corners[i]) > 0) continue;
    const Row a = corners[i].point, b = corners[i + 1 < corners.size() ? i + 1 : 0].point;
    tell(a, b);
    tell(b, a);
  }
}

void measure_stars(StarLists& lists, const Tiling& tiling, TileIndex t, Spill<ToldSampling>& post,
                   Spill<Claim>& claims) {
  const Here here(tiling, t);
  const Waiting waiting(lists, t);
  lists.waiting.drop(t);
  lists.waiting_neighbours.drop(t);
  lists.waiting_sight.drop(t);
  const std::vector<Sampling> samplings = all_samplings(waiting.in_sight, post.read(t));
  post.drop(t);
  std::vector<StoredStar> open = read_open_stars(lists, t);
  lists.open.drop(t);
  const std::vector<StoredCorner> corners = lists.open_corners.read(t);
  const std::vector<WaitingStar> stars = waiting_stars(waiting, here, open);

  Letters<Claim> letters;
  const auto surroundings = [&](std::size_t i) { return stars[i].seen; };
  BallSizer(samplings).for_each(stars.size(), surroundings, [&](std::size_t i, const BallSize& size) {
    const LocalIndex point = stars[i].seen.point;
    stars[i].star->size = size;
    stars[i].star->distance = samplings[point].distance;
    tell_triangles(waiting.row(point), *stars[i].star, corners, tiling, here, letters);
  });
  lists.open.append(t, open);
  letters.send(claims);
}

// ---- rough points, and what all of them agree on

// The stars of a tile that were not settled when it was evaluated: all points are here that may become rough.
class OpenStars {
 public:
  OpenStars(const Here& here, const RowSet& rough, std::span<const StoredStar> stars,
            std::span<const StoredCorner> corners, std::span<const Claim> claims)
      : here_(here), rough_(rough), claims_(claims), points_(stars), star_of_(here.points(), kNone) {
    for (const StoredStar& star : stars) {
      star_of_[star.owned] = static_cast<std::uint32_t>(stars_.places.size());
      stars_.places.push_back(star.place);
    }
    stars_.corners.resize(corners.size());
    stars_.agreements.resize(corners.size());
    for (const StoredStar& star : stars) {
      for (std::uint32_t c = star.place.begin; c < star.place.begin + star.place.size; ++c) {
        stars_.corners[c] = {corners[c].point, room(star, corners[c])};
        stars_.agreements[c] = stars_.corners[c].room > 0 ? Agreement::kRefused : corners[c].agreement;
      }
    }
  }

  // Corners of refused triangles of rough points are rough: until there are no more. visit(row): each
  // point found.
  template <class Visit>
  void find_rough_points(Visit&& visit) {
    for (bool go_on = true; go_on;) {
      go_on = false;
      for (std::size_t s = 0; s < points_.size(); ++s) {
        if (!rough_.contains(row(s))) continue;
        const auto [begin, size] = stars_.places[s];
        for (std::uint32_t c = begin; c < begin + size; ++c) {
          const std::uint32_t next = c + 1 < begin + size ? c + 1 : begin;
          const Row a = stars_.corners[c].point, b = stars_.corners[next].point;
          const bool is_a_rough = rough_.contains(a), is_b_rough = rough_.contains(b);
          if ((is_a_rough && is_b_rough) || !is_refused(s, c, next)) continue;
          if (!is_a_rough) visit(a);
          if (!is_b_rough) visit(b);
          go_on = true;
        }
      }
    }
  }

  // visit(gap): each gap of rough points, now that all of these are known.
  template <class Visit>
  void for_each_gap(Visit&& visit) {
    for (std::size_t s = 0; s < points_.size(); ++s) {
      if (!rough_.contains(row(s))) continue;
      const auto [begin, size] = stars_.places[s];
      for (std::uint32_t c = begin; c < begin + size; ++c) {
        if (!is_refused(s, c, c + 1 < begin + size ? c + 1 : begin))
          stars_.agreements[c] = Agreement::kAgreed;
      }
      lacuna::for_each_gap(stars_[s], std::as_const(stars_).agreements_of(s),
                           [&](Row from, Row to, float room) {
                             visit(Gap{{points_[s].id, row(s)}, from, to, room, points_[s].size.unevenness});
                           });
    }
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Row row(std::size_t s) const { return here_.row(points_[s].owned); }

  // The triangle that begins at corner a of star s.
  bool is_refused(std::size_t s, std::uint32_t a, std::uint32_t b) {
    Agreement& agreement = stars_.agreements[a];
    if (agreement == Agreement::kOpen && (refuses(a, s, b) || refuses(b, s, a)))
      agreement = Agreement::kRefused;
    return agreement == Agreement::kRefused;
  }

  // The star of a corner is asked for its triangle with the point of star s and the other corner. If it has
  // it, it is here: the triangle could not be settled before.
  bool refuses(std::uint32_t corner, std::size_t s, std::uint32_t other) const {
    const Row point = stars_.corners[corner].point, third = stars_.corners[other].point;
    if (!rough_.contains(point)) return false;
    if (!here_.owns(point))
      return !std::binary_search(claims_.begin(), claims_.end(), Claim{points_[s].owned, 0, point, third});
    const std::uint32_t star = star_of_[here_.local(point)];
    return star == kNone || !has_triangle(stars_[star], row(s), third);
  }

  const Here& here_;
  const RowSet& rough_;
  std::span<const Claim> claims_;
  std::span<const StoredStar> points_;
  Stars<Row> stars_;
  std::vector<std::uint32_t> star_of_;  // by owned index
};

// Tiles that have to look again.
class Again {
 public:
  void add(TileIndex tile) {
    const std::lock_guard lock(mutex_);
    tiles_.insert(tile);
  }
  std::vector<TileIndex> take() {
    std::vector<TileIndex> tiles(tiles_.begin(), tiles_.end());
    tiles_.clear();
    return tiles;
  }

 private:
  std::mutex mutex_;
  std::set<TileIndex> tiles_;
};

// `told`: rough points of which the tiles know whose stars they are corners of.
void settle_tile(StarLists& lists, const Tiling& tiling, TileIndex t, const Spill<Claim>& claims,
                 RowSet& told, Again& again) {
  const Here here(tiling, t);
  std::vector<Claim> here_claimed = claims.read(t);
  std::sort(here_claimed.begin(), here_claimed.end());
  const std::vector<StoredStar> open = read_open_stars(lists, t);
  OpenStars stars(here, lists.rough, open, lists.open_corners.read(t), here_claimed);
  stars.find_rough_points([&](Row row) {
    const bool is_new = lists.rough.insert(row);
    if (is_new && !here.owns(row)) again.add(tiling.tile_of_row(row));
  });
  for (auto claim = here_claimed.begin(); claim != here_claimed.end();) {
    const Row row = here.row(claim->to);
    const bool is_news = lists.rough.contains(row) && told.insert(row);
    const LocalIndex to = claim->to;
    for (; claim != here_claimed.end() && claim->to == to; ++claim) {
      if (is_news) again.add(tiling.tile_of_row(claim->from));
    }
  }
  std::vector<Gap> gaps;
  stars.for_each_gap([&](const Gap& gap) { gaps.push_back(gap); });
  lists.open_gaps.drop(t);
  lists.open_gaps.append(t, gaps);
}

}  // namespace

void settle_seams(StarLists& lists, const Tiling& tiling, Job& job) {
  const std::size_t tiles = tiling.tiles.size();
  Spill<ToldSampling> samplings(job.file("samplings"), tiles, job.memory.spills / 8);
  job.crew.for_each(
      tiles, [&](std::size_t t) { find_border_stars(lists, tiling, static_cast<TileIndex>(t), samplings); });
  Spill<Claim> claims(job.file("claims"), tiles, job.memory.spills / 8);
  job.crew.for_each(tiles, [&](std::size_t t) {
    measure_stars(lists, tiling, static_cast<TileIndex>(t), samplings, claims);
  });
  RowSet told = lists.rough;
  Again again;
  std::vector<TileIndex> unsettled(tiles);
  std::iota(unsettled.begin(), unsettled.end(), TileIndex{0});
  while (!unsettled.empty()) {
    job.crew.for_each(unsettled.size(),
                      [&](std::size_t i) { settle_tile(lists, tiling, unsettled[i], claims, told, again); });
    unsettled = again.take();
  }
  for (std::size_t t = 0; t < tiles; ++t) {
    lists.open.drop(t);
    lists.open_corners.drop(t);
  }
}

}  // namespace lacuna
