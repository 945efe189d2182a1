#include "engine/boundary/tangential/take_stars.hpp"

#include "engine/boundary/tangential/active_points.hpp"

#include <algorithm>
#include <span>

namespace lacuna {
namespace {

bool has_any(std::span<const Consistency> consistencies, Consistency wanted) {
  return std::find(consistencies.begin(), consistencies.end(), wanted) != consistencies.end();
}

// Marks points, by is_wanted(p) of the owned ones, and all of their neighbours.
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

// Wedges where all triangles are decided; else the star stays open. Returns which points have any of these.
std::vector<std::uint8_t> add_stars(const EvaluatedTile& tile, const TileStars& found, StarLists& lists) {
  const std::vector<Row>& rows = tile.points.rows;
  std::vector<std::uint8_t> is_vertex(tile.points.owned);
  std::vector<Wedge> wedges;
  OpenStars open;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    const PointState state = found.states[p];
    if (found.is_active[p]) lists.active.insert(rows[p]);
    if (!is_measured(state)) continue;
    const auto star = found.stars[p];
    const auto consistencies = found.stars.consistencies_of(p);
    if (state == PointState::kMaybeActive || has_any(consistencies, Consistency::kUndecided)) {
      is_vertex[p] = 1;
      open.add(tile.points.ids[p], p, star.bound);
      for (std::size_t i = 0; i < star.size(); ++i)
        open.add_vertex({rows[star.link[i].point], star.link[i].radius, consistencies[i]});
    } else if (has_any(consistencies, Consistency::kInconsistent)) {
      is_vertex[p] = 1;
      for_each_wedge(star, consistencies, [&](LocalIndex from, LocalIndex to, float excess) {
        wedges.push_back({tile.vertex(p), rows[from], rows[to], excess});
      });
    }
  }
  lists.append_open(tile.index, std::move(open));
  lists.wedges.append(tile.index, wedges);
  return is_vertex;
}

// The belt, and the sites and samplings that its stars need, here and in other tiles.
void add_belt(const EvaluatedTile& tile, const TileStars& found, const Tiling& tiling, StarLists& lists) {
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
    belt.push_back({.id = tile.points.ids[p],
                    .owned = p,
                    .place = place[p],
                    .neighbours = static_cast<std::uint32_t>(tile.neighbourhoods[p].size()),
                    .normal = {normal.x(), normal.y(), normal.z()},
                    .is_border = found.states[p] == PointState::kBorder});
    for (const LocalIndex q : tile.neighbourhoods[p]) neighbours.push_back(place[q]);
  }
  lists.belt.append(tile.index, belt);
  lists.belt_rows.append(tile.index, rows);
  lists.belt_neighbours.append(tile.index, neighbours);
  lists.around[tile.index] = tiling.tiles_of(rows);

  const std::span<const std::uint8_t> owned = std::span(is_around).first(tile.points.owned);
  write_wanted(lists.sites, tile, owned, [&](LocalIndex p) {
    return site_of(tile.points.positions[p], tile.points.ids[p], tile.evaluations[p]);
  });
  write_wanted(lists.samplings, tile, owned, [&](LocalIndex p) { return found.samplings[p]; });
}

}  // namespace

std::vector<std::uint8_t> take_stars(const EvaluatedTile& tile, const Tiling& tiling,
                                     const TangentialConfig& config, StarLists& lists) {
  const TileStars found =
      find_stars(tile.points, tile.neighbourhoods, tile.evaluations, tile.candidates, tile.is_border, config);
  std::vector<std::uint8_t> is_vertex = add_stars(tile, found, lists);
  add_belt(tile, found, tiling, lists);
  for (LocalIndex p = 0; p < tile.points.owned; ++p) is_vertex[p] |= is_in_belt(found.states[p]);
  return is_vertex;
}

}  // namespace lacuna
