#include "engine/passes/seams.hpp"

#include "engine/passes/letters.hpp"
#include "engine/passes/rounds.hpp"
#include "engine/stages/ball_sizes.hpp"
#include "engine/stages/open_stars.hpp"
#include "engine/stages/stars.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace lacuna {
namespace {

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
  LocalIndex place(Row row) const {
    const auto at = std::partition_point(in_sight.begin(), in_sight.end(),
                                         [&](const SeenPoint& p) { return p.vertex.row < row; });
    return static_cast<LocalIndex>(at - in_sight.begin());
  }
};

// ---- stars of border points

// Which waiting stars are measured; those that tell them of the sampling are found.
enum class Wanted { kOfRoughPoints, kAll };

// Border points whose stars are to be found. `told`: those whose stars were, and are from now on.
std::vector<StarQuery> border_points(const Waiting& waiting, const RowSet& rough, Wanted wanted,
                                     RowSet& told) {
  std::vector<std::uint8_t> is_asking;  // of points in sight: its neighbours' stars are to be found
  for (const SeenPoint& p : waiting.in_sight)
    is_asking.push_back(wanted == Wanted::kAll || rough.contains(p.vertex.row));
  std::vector<StarQuery> points;
  for (const Waiting::Point& p : waiting.points) {
    if (p.standing != Standing::kBorder) continue;
    const bool is_asked = is_asking[p.place] || std::any_of(p.neighbours.begin(), p.neighbours.end(),
                                                            [&](LocalIndex q) { return is_asking[q] != 0; });
    if (is_asked && told.insert(waiting.row(p.place))) points.push_back({p.place, p.normal, p.neighbours});
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

// Points whose stars are to be measured.
std::vector<Surroundings> waiting_points(const Waiting& waiting, const StarLists& lists, Wanted wanted) {
  std::vector<Surroundings> points;
  for (const Waiting::Point& p : waiting.points) {
    const Row row = waiting.row(p.place);
    const bool is_wanted = wanted == Wanted::kAll || lists.rough.contains(row);
    if (is_wanted && lists.unmeasured.contains(row)) points.push_back({p.place, p.neighbours});
  }
  return points;
}

// Of all points in sight: what their own tile knew, and what border points have told since.
std::vector<Sampling> all_samplings(const Waiting& waiting, std::span<const ToldSampling> told) {
  std::vector<Sampling> samplings;
  for (const SeenPoint& p : waiting.in_sight) samplings.push_back(p.sampling);
  for (const ToldSampling& news : told) samplings[waiting.place(news.row)] = news.sampling;
  return samplings;
}

// Tells the tiles of a star's foreign corners of the triangles that it has with them.
void tell_triangles(Row point, std::span<const StoredCorner> star, const Tiling& tiling, TileIndex t,
                    Letters<Claim>& letters) {
  const auto tell = [&](Row to, Row other) {
    if (tiling.tiles[t].owns(to)) return;
    const TileIndex there = tiling.tile_of_row(to);
    letters.add(there, {tiling.tiles[there].local(to), 0, point, other});
  };
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (star[i].room > 0) continue;
    const Row a = star[i].point, b = star[i + 1 < star.size() ? i + 1 : 0].point;
    tell(a, b);
    tell(b, a);
  }
}

// The tile of a point and those of its neighbours.
std::vector<TileIndex> tiles_around(const StarQuery& query, const Waiting& waiting, const Tiling& tiling) {
  std::vector<Row> rows = {waiting.row(query.point)};
  for (const LocalIndex q : query.neighbours) rows.push_back(waiting.row(q));
  return tiling.tiles_of(rows);
}

// What the tiles tell each other.
class Seams {
 public:
  Seams(StarLists& lists, const Tiling& tiling, Job& job)
      : lists_(lists),
        tiling_(tiling),
        config_(job.config.tangential),
        is_found_(tiling.tiles.size()),
        is_measured_(tiling.tiles.size()),
        told_(tiling.row_count()),
        samplings_(job.file("samplings"), tiling.tiles.size(), job.memory.spills / 8),
        claims_(job.file("claims"), tiling.tiles.size(), job.memory.spills / 8) {}

  // Stars of border points, which tell their neighbours' tiles of the sampling.
  void find_border_stars(TileIndex t, Wanted wanted) {
    if (is_found_[t]) return;
    is_found_[t] = wanted == Wanted::kAll;
    const Tile& here = tiling_.tiles[t];
    const Waiting waiting(lists_, t);
    const std::vector<StarQuery> queries = border_points(waiting, lists_.rough, wanted, told_);
    if (queries.empty()) return;

    const std::vector<Seat> seats = read_seats(queries, waiting, lists_.seats);
    StoredStars stars;
    Letters<ToldSampling> letters(samplings_);
    StarFinder(seats).for_each_batch(
        queries.size(), [&](std::size_t i) { return queries[i]; },
        [&](std::size_t first, std::span<const FoundStar> batch) {
          const std::array<Sampling, kBatchSize> samplings = samplings_of(batch, config_);
          for (std::size_t i = 0; i < batch.size(); ++i) {
            const StarQuery& query = queries[first + i];
            const FoundStar& star = batch[i];
            const Vertex& point = waiting.in_sight[query.point].vertex;
            if (star.size() > 0) stars.add(point.id, here.local(point.row));
            for (std::size_t c = 0; c < star.size(); ++c)
              stars.add_corner(
                  {waiting.row(query.neighbours[star[c].point]), star[c].room, Agreement::kOpen});
            for (const TileIndex tile : tiles_around(query, waiting, tiling_))
              letters.add(tile, {point.row, samplings[i]});
          }
        });
    lists_.found.append(t, std::move(stars));
    letters.send();
  }

  // Stars of waiting points; what the stars of their neighbours tell of the sampling is known. They tell the
  // tiles of their foreign corners of the triangles that they have with these.
  void measure_stars(TileIndex t, Wanted wanted) {
    if (is_measured_[t]) return;
    is_measured_[t] = wanted == Wanted::kAll;
    const Tile& here = tiling_.tiles[t];
    const Waiting waiting(lists_, t);
    const std::vector<Surroundings> points = waiting_points(waiting, lists_, wanted);
    if (points.empty()) return;

    const std::vector<Sampling> samplings = all_samplings(waiting, samplings_.read(t));
    const StoredStars found = lists_.found.read(t);
    StoredStars measured;
    Letters<Claim> letters(claims_);
    auto star = found.stars.begin();
    const auto surroundings = [&](std::size_t i) { return points[i]; };
    BallSizer(samplings, config_)
        .for_each(points.size(), surroundings, [&](std::size_t i, const BallSize& size) {
          const Vertex& point = waiting.in_sight[points[i].point].vertex;
          lists_.unmeasured.erase(point.row);
          while (star != found.stars.end() && here.row(star->owned) < point.row) ++star;
          if (star == found.stars.end() || here.row(star->owned) != point.row) return;
          measured.add(point.id, star->owned);
          for (StoredCorner corner : found[*star]) {
            corner.room = room_beyond(size, samplings[points[i].point], corner.room);
            if (corner.room > 0) corner.agreement = Agreement::kRefused;
            measured.add_corner(corner);
          }
          tell_triangles(point.row, measured[measured.stars.back()], tiling_, t, letters);
        });
    lists_.open.append(t, std::move(measured));
    letters.send();
  }

  // Goes on from rough point to rough point. visit(tile): tiles with new ones that others have to know of.
  template <class Visit>
  void find_rough_points(TileIndex t, Visit&& visit) {
    const Tile& here = tiling_.tiles[t];
    const StoredStars open = lists_.open.read(t);
    const std::vector<Claim> claims = sorted_claims(t);
    OpenStars(here, lists_.rough, lists_.unmeasured, open, claims).find_rough_points([&](Row row) {
      if (!here.owns(row) || lists_.unmeasured.contains(row) || is_claimed(claims, here.local(row)))
        visit(tiling_.tile_of_row(row));
    });
  }

  void find_gaps(TileIndex t) {
    const StoredStars open = lists_.open.read(t);
    const std::vector<Claim> claims = sorted_claims(t);
    OpenStars stars(tiling_.tiles[t], lists_.rough, lists_.unmeasured, open, claims);
    lists_.open_gaps.append(t, stars.gaps());
  }

 private:
  std::vector<Claim> sorted_claims(TileIndex t) const {
    std::vector<Claim> claims = claims_.read(t);
    std::sort(claims.begin(), claims.end());
    return claims;
  }

  StarLists& lists_;
  const Tiling& tiling_;
  const TangentialConfig& config_;
  std::vector<std::uint8_t> is_found_, is_measured_;  // of tiles: all their waiting stars are
  RowSet told_;                                       // border points that have told of the sampling
  AppendLists<ToldSampling> samplings_;
  AppendLists<Claim> claims_;
};

}  // namespace

void settle_seams(StarLists& lists, const Tiling& tiling, Job& job) {
  const std::size_t tiles = tiling.tiles.size();
  const auto for_each = [&](std::span<const TileIndex> some, auto&& step) {
    job.crew.for_each(some.size(), [&](std::size_t i) { step(some[i]); });
  };
  Seams seams(lists, tiling, job);
  std::vector<TileIndex> all(tiles);
  std::iota(all.begin(), all.end(), TileIndex{0});

  // Rims that go from tile to tile take a round or two. It takes more where points are rough along a border,
  // one after the other: then no star there is spared.
  constexpr int kFewRounds = 2;
  int round = 0;
  for (Rounds rounds(tiles); !rounds.tiles().empty(); rounds.next()) {
    const Wanted wanted = ++round <= kFewRounds ? Wanted::kOfRoughPoints : Wanted::kAll;
    std::set<TileIndex> with_these;
    for (const TileIndex t : rounds.tiles())
      with_these.insert(lists.around[t].begin(), lists.around[t].end());
    const std::vector<TileIndex> touched(with_these.begin(), with_these.end());
    for_each(touched, [&](TileIndex t) { seams.find_border_stars(t, wanted); });
    for_each(rounds.tiles(), [&](TileIndex t) { seams.measure_stars(t, wanted); });
    for_each(touched, [&](TileIndex t) {
      seams.find_rough_points(t, [&](TileIndex news) { rounds.request({&news, 1}); });
    });
  }
  for_each(all, [&](TileIndex t) { seams.find_gaps(t); });
  for_each(all, [&](TileIndex t) { lists.drop_waiting(t); });
}

}  // namespace lacuna
