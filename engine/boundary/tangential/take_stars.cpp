#include "engine/boundary/tangential/take_stars.hpp"

#include "engine/boundary/tangential/active_points.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace lacuna {
namespace {

class StarTaker {
 public:
  StarTaker(const EvaluatedTile& tile, const Tiling& tiling, const Config& config, StarLists& lists)
      : tile_(tile), tiling_(tiling), config_(config), lists_(lists) {}

  // Returns which owned points a loop may pass through.
  std::vector<std::uint8_t> take() {
    const TileStars found = find_stars(tile_.points, tile_.neighbourhoods, tile_.evaluations, tile_.is_border,
                                       config_.coherence.threshold, config_.tangential);
    StoredStars as_found, open;
    std::vector<Wedge> wedges;
    std::vector<std::uint8_t> is_vertex(tile_.is_border.begin(), tile_.is_border.end());
    for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
      const PointState state = found.states[p];
      if (found.is_active[p]) lists_.active.insert(tile_.points.rows[p]);
      if (waits(state)) lists_.unmeasured.insert(tile_.points.rows[p]);
      if (state == PointState::kInactive || state == PointState::kBorder) continue;
      const auto consistencies = found.stars.consistencies_of(p);
      const auto all_are = [&](auto... these) {
        return std::all_of(consistencies.begin(), consistencies.end(),
                           [&](Consistency a) { return ((a == these) || ...); });
      };
      if (state == PointState::kActive && all_are(Consistency::kConsistent)) continue;
      is_vertex[p] = 1;
      if (state == PointState::kActive && all_are(Consistency::kConsistent, Consistency::kInconsistent)) {
        for_each_wedge(found.stars[p], consistencies, [&](LocalIndex from, LocalIndex to, float room) {
          wedges.push_back({tile_.vertex(p), tile_.points.rows[from], tile_.points.rows[to], room});
        });
      } else {
        add_star(found, p, state == PointState::kBeside ? as_found : open);
      }
    }
    add_waiting(found);
    lists_.found.append(tile_.index, std::move(as_found));
    lists_.open.append(tile_.index, std::move(open));
    lists_.wedges.append(tile_.index, wedges);
    return is_vertex;
  }

 private:
  void add_star(const TileStars& found, LocalIndex p, StoredStars& stars) const {
    const auto star = found.stars[p];
    const auto consistencies = found.stars.consistencies_of(p);
    if (star.empty()) return;
    stars.add(tile_.points.ids[p], p);
    for (std::size_t i = 0; i < star.size(); ++i)
      stars.add_corner({tile_.points.rows[star[i].point], star[i].room, consistencies[i]});
  }

  // Marks owned points, by is_wanted(p), and all of their neighbours.
  template <class Wanted>
  std::vector<std::uint8_t> with_neighbours(Wanted&& is_wanted) const {
    std::vector<std::uint8_t> marks(tile_.points.size());
    for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
      if (!is_wanted(p)) continue;
      marks[p] = 1;
      for (const LocalIndex q : tile_.neighbourhoods[p]) marks[q] = 1;
    }
    return marks;
  }

  // What the stars of waiting points need, here and in other tiles.
  void add_waiting(const TileStars& found) {
    const std::vector<std::uint8_t> is_seen =
        with_neighbours([&](LocalIndex p) { return waits(found.states[p]); });
    std::vector<LocalIndex> seen;
    for (LocalIndex p = 0; p < tile_.points.size(); ++p) {
      if (is_seen[p]) seen.push_back(p);
    }
    // By row: both the owned and the foreign ones are.
    std::inplace_merge(
        seen.begin(), std::lower_bound(seen.begin(), seen.end(), tile_.points.owned), seen.end(),
        [&](LocalIndex a, LocalIndex b) { return tile_.points.rows[a] < tile_.points.rows[b]; });
    std::vector<LocalIndex> place(tile_.points.size());
    std::vector<NearbyPoint> nearby;
    std::vector<Row> rows;
    for (const LocalIndex p : seen) {
      rows.push_back(tile_.points.rows[p]);
      place[p] = static_cast<LocalIndex>(nearby.size());
      nearby.push_back({tile_.vertex(p), tile_.points.is_owned(p) ? found.samplings[p] : Sampling{}});
    }

    std::vector<WaitingPoint> waiting;
    std::vector<LocalIndex> neighbours;
    for (LocalIndex p = 0; p < tile_.points.owned; ++p) {
      if (!waits(found.states[p])) continue;
      const Eigen::Vector3d& normal = tile_.evaluations[p].normal;
      const auto around = tile_.neighbourhoods[p];
      waiting.push_back({place[p],
                         static_cast<std::uint32_t>(around.size()),
                         found.states[p],
                         {normal.x(), normal.y(), normal.z()}});
      for (const LocalIndex q : around) neighbours.push_back(place[q]);
    }
    lists_.waiting.append(tile_.index, waiting);
    lists_.waiting_neighbours.append(tile_.index, neighbours);
    lists_.waiting_nearby.append(tile_.index, nearby);
    lists_.around[tile_.index] = tiling_.tiles_of(rows);
    const std::vector<std::uint8_t> is_seated =
        with_neighbours([&](LocalIndex p) { return tile_.is_border[p] != 0; });
    write_wanted(lists_.sites, tile_, std::span(is_seated).first(tile_.points.owned), [&](LocalIndex p) {
      return site_of(tile_.points.positions[p], tile_.points.ids[p], tile_.evaluations[p]);
    });
  }

  const EvaluatedTile& tile_;
  const Tiling& tiling_;
  const Config& config_;
  StarLists& lists_;
};

}  // namespace

std::vector<std::uint8_t> take_stars(const EvaluatedTile& tile, const Tiling& tiling, const Config& config,
                                     StarLists& lists) {
  return StarTaker(tile, tiling, config, lists).take();
}

}  // namespace lacuna
