#include "engine/boundary/tangential/tangential_boundary.hpp"

#include "engine/boundary/tangential/border_exchange.hpp"
#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/take_stars.hpp"
#include "engine/store/merge_runs.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace lacuna {
namespace {

// Measured: a wedge, its curve, and the curve turned and parted.
constexpr std::uint64_t kBytesPerWedge = 160;

bool by_row(const Wedge& a, const Wedge& b) {
  return a.point.row < b.point.row;
}

// The loops along a closed curve.
void add_loops(std::vector<CurvePoint>& curve, const TangentialConfig& config, RawLoops& loops) {
  const auto least = static_cast<std::size_t>(config.min_curve);
  if (curve.size() < least) return;
  normalise(curve);
  for (const std::vector<CurvePoint>& simple : split_at_pinches(std::move(curve))) {
    if (simple.size() < least) continue;
    std::vector<Vertex> loop;
    loop.reserve(simple.size());
    for (const CurvePoint& p : simple) loop.push_back(p.vertex);
    loops.add(loop, confidence(simple, config));
  }
}

// Of a whole component.
void add_component_loops(std::vector<Wedge> wedges, const TangentialConfig& config, RawLoops& loops) {
  std::sort(wedges.begin(), wedges.end(), by_row);
  follow_curves(wedges, partners_of(wedges), std::vector<bool>(wedges.size()),
                [&](std::vector<CurvePoint>& curve) { add_loops(curve, config, loops); });
}

// A tile's part of the boundary graph. Its vertices are the wedges; those of one point are connected.
GraphPart<Wedge> part_of(std::span<const Wedge> wedges, std::span<const WedgePartners> partners,
                         std::vector<LocalIndex>& links) {
  links.assign(wedges.size(), 0);
  UnionFind connected(links);
  GraphPart<Wedge> part{.vertices = static_cast<LocalIndex>(wedges.size()), .links = links};
  for (LocalIndex i = 0; i < wedges.size(); ++i) {
    if (i > 0 && wedges[i].point == wedges[i - 1].point) connected.unite(i - 1, i);
    for (const std::size_t side : {0, 1}) {
      if (partners[i][side] != kNoIndex) {
        connected.unite(i, partners[i][side]);
      } else {
        part.crossings.push_back({i, wedges[i].point.row, side == 0 ? wedges[i].from : wedges[i].to});
      }
    }
  }
  return part;
}

// Adds the wedges of open components, those that leave the tile, to the records of the part. Returns which
// they are.
std::vector<bool> add_open_wedges(std::span<const Wedge> wedges, GraphPart<Wedge>& part) {
  UnionFind connected(part.links);
  std::vector<bool> has_crossing(wedges.size()), is_open(wedges.size());
  for (const CrossingEdge& crossing : part.crossings) has_crossing[connected.find(crossing.vertex)] = true;
  for (LocalIndex i = 0; i < wedges.size(); ++i) {
    if (!has_crossing[connected.find(i)]) continue;
    is_open[i] = true;
    part.records.push_back(wedges[i]);
    part.vertex_of.push_back(i);
  }
  return is_open;
}

}  // namespace

TangentialBoundary::TangentialBoundary(const TileStore& store, const Job& job)
    : BoundaryMethod(
          LoopPointLists(job.file("loop-points"), store.tiling().tiles.size(), job.memory.spills / 12)),
      tiling_(store.tiling()),
      stars_(store, job),
      config_(job.config) {}

void TangentialBoundary::take(const EvaluatedTile& tile) {
  add_loop_points(loop_points_, tile, take_stars(tile, tiling_, config_, stars_));
}

std::vector<Wedge> TangentialBoundary::wedges_of(TileIndex t) {
  std::vector<Wedge> wedges = stars_.wedges.read(t);
  stars_.wedges.drop(t);
  const std::vector<Wedge> open = stars_.open_wedges.read(t);
  stars_.open_wedges.drop(t);
  wedges.insert(wedges.end(), open.begin(), open.end());
  merge_runs(wedges, by_row);
  return wedges;
}

FoundLoops TangentialBoundary::find_loops(const Totals&, Job& job) {
  FoundLoops found{.loops = RawLoops(job.file("raw-loops"), job.config.selection.min_confidence)};
  Phase phase(job, "loops", 0);
  exchange_borders(stars_, tiling_, job);

  const std::size_t tiles = tiling_.tiles.size();
  const TangentialConfig& config = config_.tangential;
  Stitch<Wedge> stitch(tiles, kBytesPerWedge, job);
  job.arena.for_each(tiles, [&](std::size_t t) {
    const std::vector<Wedge> wedges = wedges_of(static_cast<TileIndex>(t));
    const std::vector<WedgePartners> partners = partners_of(wedges);
    std::atomic_ref(found.edges) += wedges.size();  // each wedge ends at two edges, each edge at two wedges
    std::vector<LocalIndex> links;
    GraphPart<Wedge> part = part_of(wedges, partners, links);
    std::vector<bool> is_open = add_open_wedges(wedges, part);
    stitch.add(static_cast<TileIndex>(t), part);
    follow_curves(wedges, partners, std::move(is_open),
                  [&](std::vector<CurvePoint>& curve) { add_loops(curve, config, found.loops); });
  });
  stitch.for_each_component(
      [&](std::span<const Wedge> wedges) {
        add_component_loops({wedges.begin(), wedges.end()}, config, found.loops);
      },
      [&](const auto& for_each_wedge, std::uint64_t count) {
        std::vector<Wedge> wedges;
        wedges.reserve(count);
        for_each_wedge([&](const Wedge& wedge) { wedges.push_back(wedge); });
        add_component_loops(std::move(wedges), config, found.loops);
      });
  found.components = stitch.components();
  found.loops.sort();
  return found;
}

}  // namespace lacuna
