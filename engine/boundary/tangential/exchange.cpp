// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/exchange.hpp"

#include "engine/config/config.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <tuple>

namespace lacuna::tangential {

// ---- What crosses tiles

bool operator<(const RemoteTriangle& a, const RemoteTriangle& b) {
  return std::tie(a.to, a.from, a.other) < std::tie(b.to, b.from, b.other);
}

StarExchange::StarExchange(const TileOutputs& outputs, const Tiling& tiling, const Spill& spill,
                           const TaskArena& arena)
    : outputs(outputs),
      tiling(tiling),
      active(tiling.row_count()),
      around(tiling.tiles.size()),
      sites(spill.file("sites")),
      samples(spill.file("samples")),
      remote_triangles(spill, "remote-triangles", tiling.tiles.size()),
      numbers_(tiling.tiles.size()),
      belt_stars_(spill, "belt-stars", tiling.tiles.size()),
      belt_vertices_(spill, "belt-vertices", tiling.tiles.size()) {
  // The sampled points of one tile after the other have places in the columns of sites and samples.
  std::uint64_t place = 0;
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    first_places_.push_back(place);
    place += outputs.count(kSampled, t);
  }
  // Tiles begin with the points that they know to be active, and with the tiles that their belts touch.
  arena.for_each(tiling.tiles.size(), [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    for (const LocalIndex p : outputs.read(kActive, t)) active.insert(tiling.tiles[t].row(p));
    around[t] = tiling.tiles_of(outputs.read(kBeltRows, t));
  });
}

void StarExchange::publish(TileIndex tile) {
  const std::vector<LocalIndex> sampled = outputs.read(kSampled, tile);
  numbers_[tile].collect(sampled.size(), [&](auto&& add) {
    for (const LocalIndex p : sampled) add(tiling.tiles[tile].row(p));
  });
  sites.write(first_places_[tile], outputs.read(kSites, tile));
  samples.write(first_places_[tile], outputs.read(kSamples, tile));
}

std::vector<Row> StarExchange::places_of(std::span<const Row> rows) const {
  std::vector<Row> places;
  places.reserve(rows.size());
  TileIndex tile = 0;
  for (const Row row : rows) {
    if (!tiling.tiles[tile].owns(row)) tile = tiling.tile_of_row(row);
    places.push_back(Row{first_places_[tile] + numbers_[tile].number(row)});
  }
  return places;
}

void StarExchange::add_belt_stars(TileIndex tile, const OpenStars& stars) {
  belt_stars_.append(tile, stars.stars);
  belt_vertices_.append(tile, stars.vertices);
}

OpenStars StarExchange::open_stars(TileIndex tile) const {
  OpenStars open{outputs.read(kOpenStars, tile), outputs.read(kOpenVertices, tile)};
  // The links of the belt's stars come last.
  const auto before = static_cast<std::uint32_t>(open.vertices.size());
  const auto of_tile = static_cast<std::ptrdiff_t>(open.stars.size());
  for (OpenStar star : belt_stars_.read(tile)) {
    star.place.begin += before;
    open.stars.push_back(star);
  }
  const std::vector<OpenLinkVertex> vertices = belt_vertices_.read(tile);
  open.vertices.insert(open.vertices.end(), vertices.begin(), vertices.end());
  std::ranges::inplace_merge(open.stars, open.stars.begin() + of_tile, {}, &OpenStar::owned);
  return open;
}

std::uint64_t StarExchange::open_star_count(TileIndex tile) const {
  return outputs.count(kOpenStars, tile) + belt_stars_.count(tile);
}

std::uint64_t StarExchange::open_vertex_count(TileIndex tile) const {
  return outputs.count(kOpenVertices, tile) + belt_vertices_.count(tile);
}

// ---- Belts: a tile's border points and their neighbours. Their stars need what other tiles know.

namespace {

// A tile's belt points, and the rows of these points and their neighbours.
class Belt {
 public:
  Belt(const TileOutputs& outputs, TileIndex t)
      : points_(outputs.read(kBelt, t)),
        rows_(outputs.read(kBeltRows, t)),
        neighbours_(outputs.read(kBeltNeighbours, t)) {
    queries_.reserve(points_.size());
    std::span<const LocalIndex> left = neighbours_;
    for (const BeltPoint& p : points_) {
      queries_.push_back({p.place, {p.normal[0], p.normal[1], p.normal[2]}, left.first(p.neighbours)});
      left = left.subspan(p.neighbours);
    }
  }
  Belt(const Belt&) = delete;
  Belt& operator=(const Belt&) = delete;

  std::span<const BeltPoint> points() const { return points_; }
  std::span<const Row> rows() const { return rows_; }              // ascending
  std::span<const StarQuery> queries() const { return queries_; }  // of each point, by places of rows

 private:
  std::vector<BeltPoint> points_;
  std::vector<Row> rows_;
  std::vector<LocalIndex> neighbours_;
  std::vector<StarQuery> queries_;
};

// Replaces the samples of a tile's border points. The tiles must have published the sites of all rows of its
// belt.
void sample_border(StarExchange& exchange, TileIndex t, const TangentialConfig& config) {
  const Belt belt(exchange.outputs, t);
  // The tile left out the stars of its border points, since their neighbours' sites are in other tiles.
  std::vector<StarQuery> queries;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < belt.points().size(); ++i) {
    if (!belt.points()[i].is_border) continue;
    queries.push_back(belt.queries()[i]);
    rows.push_back(belt.rows()[queries.back().point]);
  }
  // All tiles have published their sites: find the stars, and replace the samples of their points.
  const std::vector<Row> places = exchange.places_of(rows);
  const std::vector<Site> sites = read_rows(exchange.sites, exchange.places_of(belt.rows()));
  std::vector<StarSample> samples = read_rows(exchange.samples, places);
  StarFinder(sites).for_each_batch(
      queries.size(), [&](std::size_t i) { return queries[i]; },
      [&](std::size_t first, std::span<const FoundStar> stars) {
        const std::array<Sampling, kBatchSize> samplings = samplings_of(stars, config);
        for (std::size_t i = 0; i < stars.size(); ++i) {
          samples[first + i].sampling = samplings[i];
          samples[first + i].radii = smallest_radii(stars[i], config);
        }
      });
  replace_rows<StarSample>(exchange.samples, places, samples);
}

double distance(const Site& a, const Site& b) {
  const auto position = [](const Site& site) {
    return Eigen::Vector3d(site.position[0], site.position[1], site.position[2]);
  };
  return std::sqrt(squared_distance(position(a), position(b)));
}

// Sends the triangles of a star to the tiles of its foreign link vertices.
void send_triangles(Row point, const Star<LocalIndex>& star, std::span<const Row> rows, const Tiling& tiling,
                    TileIndex t, Outbox<RemoteTriangle>& outbox) {
  const auto send = [&](Row to, Row other, Scale scale) {
    if (tiling.tiles[t].owns(to)) return;
    const TileIndex there = tiling.tile_of_row(to);
    outbox.add(there, {tiling.tiles[there].local(to), scale, point, other});
  };
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (star.scale_of(i) == Scale::kNone) continue;
    const Row a = rows[star.link[i].point], b = rows[star.link[star.next(i)].point];
    send(a, b, star.scale_of(i));
    send(b, a, star.scale_of(i));
  }
}

// Adds the stars of a tile's belt to its open ones. Each star sends its triangles to the tiles of its foreign
// link vertices. The samples of all points of the belt's rows must be known.
//
// Looks the rows of the belt up once, and goes by their places from there on. A batch of stars is found among
// the sites, and bounded by the samplings. Each star is measured with what lies around.
void measure_belt(StarExchange& exchange, TileIndex t, const TangentialConfig& config) {
  const Belt belt(exchange.outputs, t);
  const std::vector<Row> places = exchange.places_of(belt.rows());
  const std::vector<Site> sites = read_rows(exchange.sites, places);
  const std::vector<StarSample> samples = read_rows(exchange.samples, places);
  // The bounds need the samplings of a point and its neighbours, which are complete after `sample_border`.
  std::vector<Sampling> samplings;
  samplings.reserve(samples.size());
  for (const StarSample& sample : samples) samplings.push_back(sample.sampling);
  const std::span<const StarQuery> queries = belt.queries();
  OpenStars open;
  Outbox<RemoteTriangle> outbox(exchange.remote_triangles);
  RadiusBounder bounder(samplings, config);
  RadiiAround around;
  // Each star becomes an open star of this tile. A triangle within the bound is undecided until the stars of
  // its other vertices are known. So it goes to the tiles of its foreign link vertices.
  const auto add = [&](const BeltPoint& point, const StarQuery& query, const Star<LocalIndex>& star) {
    around.gather(query.point, query.neighbours, [&](LocalIndex q) {
      return ScaledRadii{samples[q].radii, samples[q].sampling.distance};
    });
    open.add(
        point.point, point.owned, star, samplings[query.point].distance, around,
        surface_around(query.neighbours, [&](LocalIndex q) { return samples[q].surface; }),
        [&](LocalIndex q) { return std::pair(belt.rows()[q], distance(sites[query.point], sites[q])); },
        [&](std::size_t i) {
          const Scale scale = star.scale_of(i);
          return Consistency{.scale = scale, .is_undecided = scale != Scale::kNone};
        });
    send_triangles(belt.rows()[query.point], star, belt.rows(), exchange.tiling, t, outbox);
  };
  std::vector<LinkVertex<LocalIndex>> link;
  StarFinder(sites).for_each_batch(
      queries.size(), [&](std::size_t i) { return queries[i]; },
      [&](std::size_t first, std::span<const FoundStar> stars) {
        const auto surroundings = [&](std::size_t i) {
          return PointAndNeighbours{queries[first + i].point, queries[first + i].neighbours};
        };
        bounder.for_each(stars.size(), surroundings, [&](std::size_t i, const RadiusBound& bound) {
          const StarQuery& query = queries[first + i];
          link.clear();
          for (std::size_t v = 0; v < stars[i].size(); ++v)
            link.push_back({query.neighbours[stars[i][v].point], stars[i][v].radius});
          add(belt.points()[first + i], query, {link, bound});
        });
      });
  exchange.add_belt_stars(t, open);
  outbox.send();
}

// Returns the memory that `sample_border` or `measure_belt` takes.
std::uint64_t belt_bytes(const StarExchange& exchange, TileIndex t) {
  const std::uint64_t star =
      sizeof(StarQuery) + sizeof(BeltPoint) + sizeof(OpenStar) + 8 * sizeof(OpenLinkVertex);
  const TileOutputs& outputs = exchange.outputs;
  return outputs.count(kBelt, t) * star + outputs.count(kBeltNeighbours, t) * sizeof(LocalIndex) +
         outputs.count(kBeltRows, t) * (sizeof(Row) + sizeof(Site) + sizeof(StarSample) + sizeof(Sampling));
}

// ---- Growth: active points among the open stars of one tile, with the data that other tiles sent

// Returns whether any star in another tile has a triangle with this point. `remote_triangles`: sorted.
bool has_remote_triangle(std::span<const RemoteTriangle> remote_triangles, LocalIndex point) {
  const auto at = std::partition_point(remote_triangles.begin(), remote_triangles.end(),
                                       [&](const RemoteTriangle& triangle) { return triangle.to < point; });
  return at != remote_triangles.end() && at->to == point;
}

// Grows the active points of a tile along inconsistent triangles (method.md, C.4). All points that may become
// active have an open star; `remote_triangles` are sorted. A foreign star that is not measured yet makes no
// triangle inconsistent. `is_measured`, by tile, marks the tiles whose stars sent their triangles.
class Growth {
 public:
  Growth(const Tiling& tiling, TileIndex tile, std::span<const std::uint8_t> is_measured, RowSet& active,
         const OpenStars& open, std::span<const RemoteTriangle> remote_triangles);

  // Makes vertices of inconsistent triangles of active points active, here and in other tiles, until there
  // are no more. It calls visit(row) for each point that was not active before. Several tiles may grow at
  // once.
  void find_active_points(const std::function<void(Row)>& visit);

  // Returns each wedge of active points, in ascending row. All active points must be known.
  std::vector<Wedge> wedges();
  CurvePoint curve_point(const Wedge& wedge, const TangentialConfig& config) const;

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Row row(std::size_t s) const { return tile_.row(points_[s].owned); }
  bool follow(std::size_t s, const std::function<void(Row)>& visit);
  bool is_inconsistent(std::size_t s, std::size_t i);
  Scale scale_of(std::size_t s, std::size_t i);
  Scale scale_in(Row point, std::size_t s, Row third) const;

  const Tiling& tiling_;
  const Tile& tile_;
  std::span<const std::uint8_t> is_measured_;
  RowSet& active_;
  std::span<const RemoteTriangle> remote_triangles_;
  std::span<const OpenStar> points_;
  std::span<const OpenLinkVertex> vertices_;
  Stars<Row> stars_;
  std::vector<std::uint32_t> star_of_;  // by owned index
};

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

// A tile whose active points grow, or whose wedges are then known.
struct GrowingTile {
  GrowingTile(StarExchange& stars, TileIndex t, std::span<const std::uint8_t> is_measured)
      : open(stars.open_stars(t)),
        triangles(stars.remote_triangles.read(t)),
        growth(stars.tiling, t, is_measured, stars.active, open, sorted(triangles)) {}

  static std::span<const RemoteTriangle> sorted(std::vector<RemoteTriangle>& triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

  OpenStars open;
  std::vector<RemoteTriangle> triangles;
  Growth growth;
};

// Returns the tiles among `tiles` that are not marked.
std::vector<TileIndex> without_marked(std::span<const TileIndex> tiles, std::span<const std::uint8_t> marks) {
  std::vector<TileIndex> unmarked;
  for (const TileIndex t : tiles) {
    if (marks[t] == 0) unmarked.push_back(t);
  }
  return unmarked;
}

}  // namespace

// ---- The rounds

BorderExchange::BorderExchange(const TileOutputs& outputs, const Tiling& tiling,
                               const TangentialConfig& config, const Spill& spill, const Workers& workers)
    : config_(config),
      workers_(workers),
      stars_(outputs, tiling, spill, workers.arena),
      is_published_(tiling.tiles.size()),
      is_sampled_(tiling.tiles.size()),
      is_measured_(tiling.tiles.size()) {}

void BorderExchange::find_active_points() {
  for (Rounds rounds(stars_.tiling.tiles.size()); !rounds.tiles().empty(); rounds.next()) {
    const std::vector<TileIndex> tiles = with_neighbours(rounds.tiles());
    measure(tiles);
    for_each(
        tiles, [&](TileIndex t) { return growing_bytes(t); },
        [&](TileIndex t) {
          if (is_measured_[t] != 0) grow(t, rounds);
        });
  }
}

OpenWedges BorderExchange::wedges(TileIndex tile) {
  GrowingTile growing(stars_, tile, is_measured_);
  OpenWedges open{growing.growth.wedges(), {}};
  open.points.reserve(open.wedges.size());
  for (const Wedge& wedge : open.wedges) open.points.push_back(growing.growth.curve_point(wedge, config_));
  return open;
}

// A star has no more wedges at a scale than half of its link vertices.
std::uint64_t BorderExchange::most_wedges(TileIndex tile) const {
  return stars_.open_vertex_count(tile);
}

std::uint64_t BorderExchange::growing_bytes(TileIndex tile) const {
  return stars_.open_star_count(tile) * 2 * sizeof(OpenStar) +
         stars_.open_vertex_count(tile) * 2 * sizeof(OpenLinkVertex) +
         stars_.remote_triangles.count(tile) * sizeof(RemoteTriangle) +
         stars_.tiling.tiles[tile].points * sizeof(LocalIndex);
}

// Returns these tiles and all tiles that they border on.
std::vector<TileIndex> BorderExchange::with_neighbours(std::span<const TileIndex> tiles) const {
  std::set<TileIndex> all;
  for (const TileIndex t : tiles) all.insert(stars_.around[t].begin(), stars_.around[t].end());
  return {all.begin(), all.end()};
}

// Measures the belts of tiles with an active belt point. On clean scans, most tiles have none.
void BorderExchange::measure(std::span<const TileIndex> tiles) {
  std::vector<std::uint8_t> is_inactive(is_measured_);
  workers_.arena.for_each(tiles.size(), [&](std::size_t i) {
    if (!has_active_belt(tiles[i])) is_inactive[tiles[i]] = 1;
  });
  const std::vector<TileIndex> to_measure = without_marked(tiles, is_inactive);
  const std::vector<TileIndex> to_sample = without_marked(with_neighbours(to_measure), is_sampled_);
  const std::vector<TileIndex> to_publish = without_marked(with_neighbours(to_sample), is_published_);
  const auto bytes = [&](TileIndex t) { return belt_bytes(stars_, t); };
  for_each(to_publish, bytes, [&](TileIndex t) { stars_.publish(t); });
  for_each(to_sample, bytes, [&](TileIndex t) { sample_border(stars_, t, config_); });
  for_each(to_measure, bytes, [&](TileIndex t) { measure_belt(stars_, t, config_); });
  for (const TileIndex t : to_publish) is_published_[t] = 1;
  for (const TileIndex t : to_sample) is_sampled_[t] = 1;
  for (const TileIndex t : to_measure) is_measured_[t] = 1;
}

bool BorderExchange::has_active_belt(TileIndex t) const {
  const std::vector<Row> rows = stars_.outputs.read(kBeltRows, t);
  return std::any_of(rows.begin(), rows.end(), [&](Row row) {
    return stars_.tiling.tiles[t].owns(row) && stars_.active.contains(row);
  });
}

// Requests the tiles of points that become active, where another tile has to know of the point.
void BorderExchange::grow(TileIndex t, Rounds& rounds) {
  const Tile& tile = stars_.tiling.tiles[t];
  GrowingTile growing(stars_, t, is_measured_);
  growing.growth.find_active_points([&](Row row) {
    if (tile.owns(row) && !has_remote_triangle(growing.triangles, tile.local(row))) return;
    const TileIndex owner = stars_.tiling.tile_of_row(row);
    rounds.request({&owner, 1});
  });
}

template <class Bytes, class Step>
void BorderExchange::for_each(std::span<const TileIndex> tiles, Bytes&& bytes, Step&& step) {
  std::vector<std::uint64_t> needs;
  needs.reserve(tiles.size());
  for (const TileIndex t : tiles) needs.push_back(bytes(t));
  workers_.for_each_within(workers_.memory.work, needs, [&](std::size_t i) { step(tiles[i]); });
}

}  // namespace lacuna::tangential
