// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/belt.hpp"

#include "engine/boundary/tangential/radius_bound.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/store/outbox.hpp"
#include "engine/store/row_runs.hpp"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace lacuna::tangential {
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

}  // namespace

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
    around.gather(query.point, query.neighbours,
                  [&](LocalIndex q) { return ScaledRadii{samples[q].radii, samples[q].sampling.distance}; });
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

std::uint64_t belt_bytes(const StarExchange& exchange, TileIndex t) {
  const std::uint64_t star =
      sizeof(StarQuery) + sizeof(BeltPoint) + sizeof(OpenStar) + 8 * sizeof(OpenLinkVertex);
  const TileOutputs& outputs = exchange.outputs;
  return outputs.count(kBelt, t) * star + outputs.count(kBeltNeighbours, t) * sizeof(LocalIndex) +
         outputs.count(kBeltRows, t) * (sizeof(Row) + sizeof(Site) + sizeof(StarSample) + sizeof(Sampling));
}

}  // namespace lacuna::tangential
