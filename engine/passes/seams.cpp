#include "engine/passes/seams.hpp"

#include "engine/stages/ball_sizes.hpp"
#include "engine/stages/rims.hpp"
#include "engine/stages/stars.hpp"

#include <algorithm>
#include <map>
#include <tuple>

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

  bool owns(const Vertex& v) const { return value(v.row) - first_ < points_; }
  LocalIndex local(const Vertex& v) const { return static_cast<LocalIndex>(value(v.row) - first_); }
  Row row(LocalIndex owned) const { return Row{first_ + owned}; }

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

// Border points that are rough, now that all suspects are known.
std::vector<StarQuery> rough_ones(const Waiting& waiting, const RowSet& suspects) {
  const auto is_suspect = [&](LocalIndex place) { return suspects.contains(waiting.row(place)); };
  std::vector<StarQuery> rough;
  for (const Waiting::Point& p : waiting.points) {
    if (p.standing != Standing::kBorder) continue;
    if (is_suspect(p.place) || std::any_of(p.neighbours.begin(), p.neighbours.end(), is_suspect))
      rough.push_back({p.place, p.normal, p.neighbours});
  }
  return rough;
}

// Of the points that ask and of their neighbours; none of the others.
std::vector<Seat> read_seats(std::span<const StarQuery> queries, const Waiting& waiting,
                             const Column<Seat>& stored) {
  std::vector<std::uint8_t> is_needed(waiting.in_sight.size());
  for (const StarQuery& query : queries) {
    is_needed[query.point] = 1;
    for (const LocalIndex q : query.neighbours) is_needed[q] = 1;
  }
  // In runs of rows that are near each other. Between them most were never written: reading those, too, would
  // fill the system's cache with zeros.
  constexpr std::uint64_t kNear = 8;
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
  const std::vector<StarQuery> queries = rough_ones(waiting, lists.suspects);
  const std::vector<Seat> seats = read_seats(queries, waiting, lists.seats);

  std::vector<StoredCorner> stars;
  Letters<ToldSampling> letters;
  std::vector<TileIndex> tiles;
  const auto tell = [&](const StarQuery& query, const FoundStar& star, const Sampling& sampling) {
    const Vertex& point = waiting.in_sight[query.point].vertex;
    lists.rough.insert(point.row);
    for (std::size_t c = 0; c < star.size(); ++c) {
      const LocalIndex corner = query.neighbours[star[c].point];
      stars.push_back(
          {point.id, here.local(point), Agreement::kOpen, waiting.in_sight[corner].vertex, star[c].room, 0});
    }
    tiles.assign(1, t);
    for (const LocalIndex q : query.neighbours) {
      if (!here.owns(waiting.in_sight[q].vertex)) tiles.push_back(tiling.tile_of_row(waiting.row(q)));
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

// Corners by star.
void sort_by_star(std::vector<StoredCorner>& corners) {
  std::stable_sort(corners.begin(), corners.end(),
                   [](const auto& a, const auto& b) { return a.owned < b.owned; });
}

// A star that waited to be measured.
struct WaitingStar {
  Surroundings seen;  // by their places in sight
  std::span<StoredCorner> corners;
};

// The stars of waiting points. `corners`: of these and of other points, by star.
std::vector<WaitingStar> waiting_stars(const Waiting& waiting, const Here& here,
                                       std::span<StoredCorner> corners) {
  std::vector<WaitingStar> stars;
  for (const Waiting::Point& p : waiting.points) {
    const LocalIndex owned = here.local(waiting.in_sight[p.place].vertex);
    const auto is_before = [&](const StoredCorner& c) { return c.owned < owned; };
    corners = corners.subspan(static_cast<std::size_t>(
        std::find_if_not(corners.begin(), corners.end(), is_before) - corners.begin()));
    std::size_t count = 0;
    while (count < corners.size() && corners[count].owned == owned) ++count;
    if (count > 0) stars.push_back({{p.place, p.neighbours}, corners.first(count)});
  }
  return stars;
}

// Tells the tiles of a star's foreign corners of the triangles that it has with them.
void tell_triangles(const Vertex& point, std::span<const StoredCorner> star, const Tiling& tiling,
                    const Here& here, Letters<Claim>& letters) {
  const auto tell = [&](const Vertex& to, const Vertex& other) {
    if (here.owns(to)) return;
    const TileIndex tile = tiling.tile_of_row(to.row);
    letters.add(tile, {Here(tiling, tile).local(to), 0, point.row, other.row});
  };
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (star[i].room > 0) continue;
    const Vertex &a = star[i].corner, &b = star[i + 1 < star.size() ? i + 1 : 0].corner;
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
  std::vector<StoredCorner> corners = lists.open.read(t);
  lists.open.drop(t);
  sort_by_star(corners);
  const std::vector<WaitingStar> stars = waiting_stars(waiting, here, corners);

  Letters<Claim> letters;
  const auto surroundings = [&](std::size_t i) { return stars[i].seen; };
  BallSizer(samplings).for_each(stars.size(), surroundings, [&](std::size_t i, const BallSize& size) {
    const LocalIndex point = stars[i].seen.point;
    for (StoredCorner& corner : stars[i].corners) {
      corner.room = room_beyond(size, samplings[point], corner.room);
      corner.unevenness = size.unevenness;
      if (corner.room > 0) corner.agreement = Agreement::kRefused;
    }
    tell_triangles(waiting.in_sight[point].vertex, stars[i].corners, tiling, here, letters);
  });
  lists.open.append(t, corners);
  letters.send(claims);
}

// ---- what all corners agree on

// The stars of a tile that were not settled when it was evaluated.
class OpenStars {
 public:
  OpenStars(const Here& here, std::vector<StoredCorner> corners) {
    sort_by_star(corners);
    for (const StoredCorner& c : corners) {
      if (points_.empty() || points_.back() != c.owned) {
        points_.push_back(c.owned);
        vertices_.push_back({c.id, here.row(c.owned)});
        unevenness_.push_back(c.unevenness);
        stars_.offsets.push_back(stars_.offsets.back());
      }
      stars_.corners.push_back({c.corner, c.room});
      stars_.agreements.push_back(c.agreement);
      ++stars_.offsets.back();
    }
  }

  std::span<const LocalIndex> points() const { return points_; }
  const Vertex& vertex(std::size_t i) const { return vertices_[i]; }
  float unevenness(std::size_t i) const { return unevenness_[i]; }
  std::span<const StarCorner<Vertex>> star(std::size_t i) const { return stars_[i]; }
  std::span<Agreement> agreements(std::size_t i) {
    return std::span(stars_.agreements).subspan(stars_.offsets[i], stars_[i].size());
  }

  // An owned corner has its triangle with a and b, one of the three a waiting point. If it has, it is here:
  // the triangle could not be settled before.
  bool agrees(LocalIndex corner, const Vertex& a, const Vertex& b) const {
    const auto at = std::lower_bound(points_.begin(), points_.end(), corner);
    return at != points_.end() && *at == corner &&
           has_triangle(stars_[static_cast<std::size_t>(at - points_.begin())], a, b);
  }

 private:
  std::vector<LocalIndex> points_;  // ascending
  std::vector<Vertex> vertices_;    // the same
  std::vector<float> unevenness_;
  Stars<Vertex> stars_;
};

void agree(StarLists& lists, const Tiling& tiling, TileIndex t, Spill<Claim>& claims) {
  const Here here(tiling, t);
  OpenStars stars(here, lists.open.read(t));
  lists.open.drop(t);
  std::vector<Claim> told = claims.read(t);
  claims.drop(t);
  std::sort(told.begin(), told.end());

  std::vector<Gap> gaps;
  Letters<GapEnd> letters;
  for (std::size_t s = 0; s < stars.points().size(); ++s) {
    const LocalIndex p = stars.points()[s];
    const auto star = stars.star(s);
    const auto agreements = stars.agreements(s);
    const Vertex point = stars.vertex(s);
    const auto agrees = [&](const Vertex& corner, const Vertex& other) {
      if (!lists.rough.contains(corner.row)) return true;
      if (here.owns(corner)) return stars.agrees(here.local(corner), point, other);
      return std::binary_search(told.begin(), told.end(), Claim{p, 0, corner.row, other.row});
    };
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (agreements[i] != Agreement::kOpen) continue;
      const Vertex &a = star[i].point, &b = star[i + 1 < star.size() ? i + 1 : 0].point;
      agreements[i] = agrees(a, b) && agrees(b, a) ? Agreement::kAgreed : Agreement::kRefused;
    }
    const auto tell_if_inner = [&](const Vertex& end) {
      if (!here.owns(end) && !lists.rough.contains(end.row))
        letters.add(tiling.tile_of_row(end.row), {end, point});
    };
    for_each_gap(star, std::span<const Agreement>(agreements),
                 [&](const Vertex& from, const Vertex& to, float room) {
                   gaps.push_back({point, from, to, room, stars.unevenness(s)});
                   tell_if_inner(from);
                   tell_if_inner(to);
                 });
  }
  lists.gaps.append(t, gaps);
  letters.send(lists.inner_ends);
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
  job.crew.for_each(tiles, [&](std::size_t t) { agree(lists, tiling, static_cast<TileIndex>(t), claims); });
}

}  // namespace lacuna
