// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/emit_stars.hpp"

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/tangential/active_points.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace lacuna::tangential {
namespace {

bool is_any_undecided(std::span<const Consistency> consistencies) {
  return std::any_of(consistencies.begin(), consistencies.end(),
                     [](const Consistency& c) { return c.is_undecided; });
}
bool is_any_inconsistent(std::span<const Consistency> consistencies) {
  return std::any_of(consistencies.begin(), consistencies.end(),
                     [](const Consistency& c) { return !c.at(Scale::kFine); });
}

// The circumradii around points of a tile.
class TileRadii {
 public:
  TileRadii(const EvaluatedTile& tile, const TileStars& found, const TangentialConfig& config)
      : tile_(tile), found_(found), config_(config), of_star_(tile.points.size(), kUnknown) {}

  const StarRadii& of_star(LocalIndex p) {
    StarRadii& radii = of_star_[p];
    if (radii.radii[0] < 0) radii = smallest_radii(found_.stars[p].link, config_);
    return radii;
  }

  // Returns the mean surface share of a point's neighbours.
  float surface_around(LocalIndex p) const {
    const std::span<const LocalIndex> neighbours = tile_.neighbourhoods[p];
    float sum = 0;
    for (const LocalIndex q : neighbours) sum += tile_.evaluations[q].surface_share;
    return sum / static_cast<float>(neighbours.size());
  }

  // The last point's radii are kept: both scales of a point need them.
  SamplingRadius& around(LocalIndex p) {
    if (at_ == p) return radii_;
    at_ = p;
    radii_.clear();
    radii_.add(of_star(p), found_.samplings[p].distance);
    for (const LocalIndex q : tile_.neighbourhoods[p]) radii_.add(of_star(q), found_.samplings[q].distance);
    return radii_;
  }

 private:
  static constexpr StarRadii kUnknown{{-1}};

  const EvaluatedTile& tile_;
  const TileStars& found_;
  const TangentialConfig& config_;
  std::vector<StarRadii> of_star_;
  SamplingRadius radii_;
  LocalIndex at_ = kNoIndex;  // the point of `radii_`
};

// Returns the seeds, ascending.
std::vector<LocalIndex> seeds_of(const EvaluatedTile& tile, double seed_probability) {
  std::vector<LocalIndex> seeds;
  std::copy_if(tile.candidates.begin(), tile.candidates.end(), std::back_inserter(seeds),
               [&](LocalIndex p) { return tile.evaluations[p].probability > seed_probability; });
  return seeds;
}

// Marks the owned points for which is_wanted(p) is true, and all of their neighbours.
template <class Wanted>
std::vector<std::uint8_t> with_neighbours(const EvaluatedTile& tile, Wanted&& is_wanted) {
  std::vector<std::uint8_t> marks(tile.points.size());
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!is_wanted(p)) continue;
    marks[p] = 1;
    for (const LocalIndex q : tile.neighbourhoods[p]) marks[q] = 1;
  }
  return marks;
}

// Emits wedges where all triangles are decided; else the star stays open.
void emit_wedges(const EvaluatedTile& tile, const TileStars& found, TileRadii& radii,
                 const TangentialConfig& config, TileOutput& output) {
  const std::vector<Row>& rows = tile.points.rows;
  std::vector<LocalIndex> active;
  std::vector<Wedge> wedges;
  OpenStars open;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    const PointState state = found.states[p];
    if (found.is_active[p]) active.push_back(p);
    if (!is_measured(state)) continue;
    const auto star = found.stars[p];
    const auto consistencies = found.stars.consistencies_of(p);
    const auto end = [&](std::size_t i) {
      const LocalIndex q = star.link[i].point;
      return LinkEnd{rows[q],
                     std::sqrt(squared_distance(tile.points.positions[q], tile.points.positions[p]))};
    };
    const double distance = found.samplings[p].distance;
    if (state == PointState::kMaybeActive || is_any_undecided(consistencies)) {
      open.add(loop_point_of(tile, p), p, star.bound, distance, radii.around(p), radii.surface_around(p));
      for (std::size_t i = 0; i < star.size(); ++i)
        open.add_vertex({.end = end(i), .radius = star.link[i].radius, .consistency = consistencies[i]});
    } else if (is_any_inconsistent(consistencies)) {
      const auto around = [&](Scale scale) {
        return WedgeSurroundings{radii.around(p).within(star.bound.at(scale) * distance),
                                 radii.surface_around(p)};
      };
      add_wedges({loop_point_of(tile, p), rows[p], distance}, star, consistencies, around, end, config,
                 wedges);
    }
  }
  output.add(kActive, std::move(active));
  output.add(kOpenStars, std::move(open.stars));
  output.add(kOpenVertices, std::move(open.vertices));
  output.add(kWedges, std::move(wedges));
}

// Emits the belt, and the sites and samplings that its stars need, here and in other tiles.
void emit_belt(const EvaluatedTile& tile, const TileStars& found, TileRadii& radii, TileOutput& output) {
  const auto is_around = with_neighbours(tile, [&](LocalIndex p) { return is_in_belt(found.states[p]); });
  std::vector<LocalIndex> around;
  for (LocalIndex p = 0; p < tile.points.size(); ++p) {
    if (is_around[p]) around.push_back(p);
  }
  // Rows ascend among the owned points, and among the foreign ones.
  std::inplace_merge(around.begin(), std::lower_bound(around.begin(), around.end(), tile.points.owned),
                     around.end(),
                     [&](LocalIndex a, LocalIndex b) { return tile.points.rows[a] < tile.points.rows[b]; });
  std::vector<LocalIndex> place(tile.points.size());
  std::vector<Row> rows;
  for (const LocalIndex p : around) {
    place[p] = static_cast<LocalIndex>(rows.size());
    rows.push_back(tile.points.rows[p]);
  }

  std::vector<BeltPoint> belt;
  std::vector<LocalIndex> neighbours;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!is_in_belt(found.states[p])) continue;
    const Eigen::Vector3d& normal = tile.evaluations[p].normal;
    belt.push_back({.point = loop_point_of(tile, p),
                    .owned = p,
                    .place = place[p],
                    .neighbours = static_cast<std::uint32_t>(tile.neighbourhoods[p].size()),
                    .normal = {normal.x(), normal.y(), normal.z()},
                    .is_border = found.states[p] == PointState::kBorder});
    for (const LocalIndex q : tile.neighbourhoods[p]) neighbours.push_back(place[q]);
  }
  output.add(kBelt, std::move(belt));
  output.add(kBeltRows, std::move(rows));
  output.add(kBeltNeighbours, std::move(neighbours));

  std::vector<LocalIndex> owned;
  std::vector<Site> sites;
  std::vector<StarSample> samples;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!is_around[p]) continue;
    owned.push_back(p);
    sites.push_back(site_of(tile.points.positions[p], tile.points.ids[p], tile.evaluations[p]));
    samples.push_back({found.samplings[p], radii.of_star(p), tile.evaluations[p].surface_share});
  }
  output.add(kSampled, std::move(owned));
  output.add(kSites, std::move(sites));
  output.add(kSamples, std::move(samples));
}

}  // namespace

void emit_stars(const EvaluatedTile& tile, const TangentialConfig& config, TileOutput& output) {
  const TileStars found = find_stars(tile.points, tile.neighbourhoods, tile.evaluations,
                                     seeds_of(tile, config.seed_probability), tile.is_border, config);
  TileRadii radii(tile, found, config);
  emit_wedges(tile, found, radii, config, output);
  emit_belt(tile, found, radii, output);
}

}  // namespace lacuna::tangential
