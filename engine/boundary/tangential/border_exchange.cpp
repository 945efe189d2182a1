#include "engine/boundary/tangential/border_exchange.hpp"

#include "engine/boundary/tangential/open_stars.hpp"
#include "engine/boundary/tangential/radius_bound.hpp"
#include "engine/boundary/tangential/stars.hpp"
#include "engine/run/rounds.hpp"
#include "engine/store/outbox.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace lacuna {
namespace {

// Of a border point; told to its own tile and to those of its neighbours.
struct SentSampling {
  Row row;
  Sampling sampling;
};

// The points of a tile that wait, and what they see.
struct Waiting {
  struct Point {
    LocalIndex place;  // in sight
    PointState state;
    Eigen::Vector3d normal;
    std::span<const LocalIndex> neighbours;  // places in sight
  };
  std::vector<NearbyPoint> nearby;
  std::vector<LocalIndex> all_neighbours;
  std::vector<Point> points;

  Waiting(const StarLists& lists, TileIndex t)
      : nearby(lists.waiting_nearby.read(t)), all_neighbours(lists.waiting_neighbours.read(t)) {
    std::span<const LocalIndex> left = all_neighbours;
    for (const WaitingPoint& p : lists.waiting.read(t)) {
      points.push_back({p.place, p.state, {p.normal[0], p.normal[1], p.normal[2]}, left.first(p.neighbours)});
      left = left.subspan(p.neighbours);
    }
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  Row row(LocalIndex place) const { return nearby[place].vertex.row; }
  LocalIndex place(Row row) const {
    const auto at = std::partition_point(nearby.begin(), nearby.end(),
                                         [&](const NearbyPoint& p) { return p.vertex.row < row; });
    return static_cast<LocalIndex>(at - nearby.begin());
  }
};

// ---- stars of border points

// Which waiting stars are measured; those that tell them of the sampling are found.
enum class Wanted { kOfRoughPoints, kAll };

// Border points whose stars are to be found. `told`: those whose stars were, and are from now on.
std::vector<StarQuery> border_points(const Waiting& waiting, const RowSet& active, Wanted wanted,
                                     RowSet& told) {
  std::vector<std::uint8_t> is_asking;  // of points in sight: its neighbours' stars are to be found
  for (const NearbyPoint& p : waiting.nearby)
    is_asking.push_back(wanted == Wanted::kAll || active.contains(p.vertex.row));
  std::vector<StarQuery> points;
  for (const Waiting::Point& p : waiting.points) {
    if (p.state != PointState::kBorder) continue;
    const bool is_asked = is_asking[p.place] || std::any_of(p.neighbours.begin(), p.neighbours.end(),
                                                            [&](LocalIndex q) { return is_asking[q] != 0; });
    if (is_asked && told.insert(waiting.row(p.place))) points.push_back({p.place, p.normal, p.neighbours});
  }
  return points;
}

// Of the points that ask and of their neighbours; none of the others.
std::vector<Site> read_seats(std::span<const StarQuery> queries, const Waiting& waiting,
                             const Column<Site>& stored) {
  std::vector<std::uint8_t> is_needed(waiting.nearby.size());
  for (const StarQuery& query : queries) {
    is_needed[query.point] = 1;
    for (const LocalIndex q : query.neighbours) is_needed[q] = 1;
  }
  // In runs of rows that are near each other. What is farther between them was mostly never written: reading
  // that, too, would fill the system's cache with zeros.
  constexpr std::uint64_t kNear = 64;
  const auto row = [&](std::size_t i) { return value(waiting.row(static_cast<LocalIndex>(i))); };
  std::vector<Site> sites(waiting.nearby.size());
  std::vector<Site> run;
  for (std::size_t i = 0; i < sites.size();) {
    if (!is_needed[i]) {
      ++i;
      continue;
    }
    std::size_t last = i;
    for (std::size_t j = i + 1; j < sites.size() && row(j) <= row(last) + kNear; ++j) {
      if (is_needed[j]) last = j;
    }
    const std::uint64_t first_row = row(i);
    run.resize(row(last) - first_row + 1);
    stored.read(first_row, std::span(run));
    for (; i <= last; ++i) sites[i] = run[row(i) - first_row];
  }
  return sites;
}

// Points whose stars are to be measured.
std::vector<Surroundings> waiting_points(const Waiting& waiting, const StarLists& lists, Wanted wanted) {
  std::vector<Surroundings> points;
  for (const Waiting::Point& p : waiting.points) {
    const Row row = waiting.row(p.place);
    const bool is_wanted = wanted == Wanted::kAll || lists.active.contains(row);
    if (is_wanted && lists.unmeasured.contains(row)) points.push_back({p.place, p.neighbours});
  }
  return points;
}

// Of all points in sight: what their own tile knew, and what border points have told since.
std::vector<Sampling> all_samplings(const Waiting& waiting, std::span<const SentSampling> told) {
  std::vector<Sampling> samplings;
  for (const NearbyPoint& p : waiting.nearby) samplings.push_back(p.sampling);
  for (const SentSampling& news : told) samplings[waiting.place(news.row)] = news.sampling;
  return samplings;
}

// Tells the tiles of a star's foreign corners of the triangles that it has with them.
void tell_triangles(Row point, std::span<const StoredLinkVertex> star, const Tiling& tiling, TileIndex t,
                    Outbox<RemoteTriangle>& outbox) {
  const auto tell = [&](Row to, Row other) {
    if (tiling.tiles[t].owns(to)) return;
    const TileIndex there = tiling.tile_of_row(to);
    outbox.add(there, {tiling.tiles[there].local(to), 0, point, other});
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
class BorderExchange {
 public:
  BorderExchange(StarLists& lists, const Tiling& tiling, Job& job)
      : lists_(lists),
        tiling_(tiling),
        config_(job.config.tangential),
        is_found_(tiling.tiles.size()),
        is_measured_(tiling.tiles.size()),
        sent_(tiling.row_count()),
        samplings_(job.file("samplings"), tiling.tiles.size(), job.memory.spills / 8),
        remote_triangles_(job.file("remote_triangles"), tiling.tiles.size(), job.memory.spills / 8) {}

  // Stars of border points, which tell their neighbours' tiles of the sampling.
  void find_border_stars(TileIndex t, Wanted wanted) {
    if (is_found_[t]) return;
    is_found_[t] = wanted == Wanted::kAll;
    const Tile& here = tiling_.tiles[t];
    const Waiting waiting(lists_, t);
    const std::vector<StarQuery> queries = border_points(waiting, lists_.active, wanted, sent_);
    if (queries.empty()) return;

    const std::vector<Site> sites = read_seats(queries, waiting, lists_.sites);
    StoredStars stars;
    Outbox<SentSampling> outbox(samplings_);
    StarFinder(sites).for_each_batch(
        queries.size(), [&](std::size_t i) { return queries[i]; },
        [&](std::size_t first, std::span<const FoundStar> batch) {
          const std::array<Sampling, kBatchSize> samplings = samplings_of(batch, config_);
          for (std::size_t i = 0; i < batch.size(); ++i) {
            const StarQuery& query = queries[first + i];
            const FoundStar& star = batch[i];
            const Vertex& point = waiting.nearby[query.point].vertex;
            if (star.size() > 0) stars.add(point.id, here.local(point.row));
            for (std::size_t c = 0; c < star.size(); ++c)
              stars.add_corner(
                  {waiting.row(query.neighbours[star[c].point]), star[c].room, Consistency::kUndecided});
            for (const TileIndex tile : tiles_around(query, waiting, tiling_))
              outbox.add(tile, {point.row, samplings[i]});
          }
        });
    lists_.found.append(t, std::move(stars));
    outbox.send();
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
    Outbox<RemoteTriangle> outbox(remote_triangles_);
    auto star = found.stars.begin();
    const auto surroundings = [&](std::size_t i) { return points[i]; };
    RadiusBounder(samplings, config_)
        .for_each(points.size(), surroundings, [&](std::size_t i, const RadiusBound& size) {
          const Vertex& point = waiting.nearby[points[i].point].vertex;
          lists_.unmeasured.erase(point.row);
          while (star != found.stars.end() && here.row(star->owned) < point.row) ++star;
          if (star == found.stars.end() || here.row(star->owned) != point.row) return;
          measured.add(point.id, star->owned);
          for (StoredLinkVertex corner : found[*star]) {
            corner.room = room_beyond(size, samplings[points[i].point], corner.room);
            if (corner.room > 0) corner.consistency = Consistency::kInconsistent;
            measured.add_corner(corner);
          }
          tell_triangles(point.row, measured[measured.stars.back()], tiling_, t, outbox);
        });
    lists_.open.append(t, std::move(measured));
    outbox.send();
  }

  // Goes on from active point to active point. visit(tile): tiles with new ones that others have to know of.
  template <class Visit>
  void find_active_points(TileIndex t, Visit&& visit) {
    const Tile& here = tiling_.tiles[t];
    const StoredStars open = lists_.open.read(t);
    const std::vector<RemoteTriangle> remote_triangles = sorted_claims(t);
    OpenStars(here, lists_.active, lists_.unmeasured, open, remote_triangles)
        .find_active_points([&](Row row) {
          if (!here.owns(row) || lists_.unmeasured.contains(row) ||
              has_remote_triangle(remote_triangles, here.local(row)))
            visit(tiling_.tile_of_row(row));
        });
  }

  void find_wedges(TileIndex t) {
    const StoredStars open = lists_.open.read(t);
    const std::vector<RemoteTriangle> remote_triangles = sorted_claims(t);
    OpenStars stars(tiling_.tiles[t], lists_.active, lists_.unmeasured, open, remote_triangles);
    lists_.open_wedges.append(t, stars.wedges());
  }

 private:
  std::vector<RemoteTriangle> sorted_claims(TileIndex t) const {
    std::vector<RemoteTriangle> remote_triangles = remote_triangles_.read(t);
    std::sort(remote_triangles.begin(), remote_triangles.end());
    return remote_triangles;
  }

  StarLists& lists_;
  const Tiling& tiling_;
  const TangentialConfig& config_;
  std::vector<std::uint8_t> is_found_, is_measured_;  // of tiles: all their waiting stars are
  RowSet sent_;                                       // border points that have told of the sampling
  AppendLists<SentSampling> samplings_;
  AppendLists<RemoteTriangle> remote_triangles_;
};

}  // namespace

void exchange_borders(StarLists& lists, const Tiling& tiling, Job& job) {
  const std::size_t tiles = tiling.tiles.size();
  const auto for_each = [&](std::span<const TileIndex> some, auto&& step) {
    job.arena.for_each(some.size(), [&](std::size_t i) { step(some[i]); });
  };
  BorderExchange seams(lists, tiling, job);
  std::vector<TileIndex> all(tiles);
  std::iota(all.begin(), all.end(), TileIndex{0});

  // Rims that go from tile to tile take a round or two. It takes more where points are active along a border,
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
      seams.find_active_points(t, [&](TileIndex news) { rounds.request({&news, 1}); });
    });
  }
  for_each(all, [&](TileIndex t) { seams.find_wedges(t); });
  for_each(all, [&](TileIndex t) { lists.drop_waiting(t); });
}

}  // namespace lacuna
