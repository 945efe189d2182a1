#include "engine/boundary/tangential/tangential_boundary.hpp"

#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/take_stars.hpp"
#include "engine/core/merge_runs.hpp"
#include "engine/passes/seams.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace lacuna {
namespace {

// Measured: a wedge, its curve, and the curve turned and parted.
constexpr std::uint64_t kBytesPerWedge = 160;

void add_loops(std::vector<Gap> wedges, RawLoops& loops) {
  follow_curves(std::move(wedges), [&](std::vector<RimPoint>& curve) {
    if (curve.size() < kLeastCurve) return;
    normalise(curve);
    for (const std::vector<RimPoint>& simple : split_at_pinches(std::move(curve))) {
      if (simple.size() < kLeastCurve) continue;
      std::vector<Vertex> loop;
      loop.reserve(simple.size());
      for (const RimPoint& p : simple) loop.push_back(p.vertex);
      loops.add(loop, confidence(simple));
    }
  });
}

// The graph of a tile's wedges, in ascending row: their points, and edges to the points at their ends.
GraphPart<Gap> graph_of(std::vector<Gap> wedges, const Tile& tile, std::vector<LocalIndex>& links) {
  GraphPart<Gap> part;
  std::vector<Row> points;
  for (const Gap& wedge : wedges) {
    if (points.empty() || points.back() != wedge.point.row) points.push_back(wedge.point.row);
    part.vertex_of.push_back(static_cast<LocalIndex>(points.size() - 1));
  }
  links.assign(points.size(), 0);
  UnionFind connected(links);
  for (std::size_t i = 0; i < wedges.size(); ++i) {
    for (const Row end : {wedges[i].from, wedges[i].to}) {
      if (tile.owns(end)) {
        const auto at = std::lower_bound(points.begin(), points.end(), end);
        connected.unite(part.vertex_of[i], static_cast<LocalIndex>(at - points.begin()));
      } else {
        part.crossings.push_back({part.vertex_of[i], wedges[i].point.row, end});
      }
    }
  }
  part.vertices = static_cast<LocalIndex>(points.size());
  part.links = links;
  part.records = std::move(wedges);
  return part;
}

}  // namespace

TangentialBoundary::TangentialBoundary(const TileStore& store, const Job& job)
    : BoundaryMethod(
          LoopPointLists(job.file("loop-points"), store.tiling().tiles.size(), job.memory.spills / 12)),
      tiling_(store.tiling()),
      stars_(store, job) {}

void TangentialBoundary::take(const EvaluatedTile& tile) {
  add_loop_points(loop_points_, tile, take_stars(tile, tiling_, stars_));
}

std::vector<Gap> TangentialBoundary::wedges_of(TileIndex t) {
  std::vector<Gap> wedges = stars_.gaps.read(t);
  stars_.gaps.drop(t);
  const std::vector<Gap> open = stars_.open_gaps.read(t);
  stars_.open_gaps.drop(t);
  wedges.insert(wedges.end(), open.begin(), open.end());
  merge_runs(wedges, [](const Gap& a, const Gap& b) { return a.point.row < b.point.row; });
  return wedges;
}

FoundLoops TangentialBoundary::find_loops(const Totals&, Job& job) {
  FoundLoops found{.loops = RawLoops(job.file("raw-loops"), job.config.selection.min_confidence)};
  Phase phase(job, "loops", 0);
  settle_seams(stars_, tiling_, job);

  const std::size_t tiles = tiling_.tiles.size();
  Stitch<Gap> stitch(tiles, kBytesPerWedge, job);
  job.crew.for_each(tiles, [&](std::size_t t) {
    std::vector<Gap> wedges = wedges_of(static_cast<TileIndex>(t));
    std::atomic_ref(found.edges) += wedges.size();  // each wedge ends at two edges, each edge at two wedges
    std::vector<LocalIndex> links;
    add_loops(stitch.add(static_cast<TileIndex>(t), graph_of(std::move(wedges), tiling_.tiles[t], links)),
              found.loops);
  });
  stitch.for_each_component(
      [&](std::span<const Gap> wedges) { add_loops({wedges.begin(), wedges.end()}, found.loops); },
      [&](const auto& for_each_wedge, std::uint64_t count) {
        std::vector<Gap> wedges;
        wedges.reserve(count);
        for_each_wedge([&](const Gap& wedge) { wedges.push_back(wedge); });
        add_loops(std::move(wedges), found.loops);
      });
  found.components = stitch.components();
  found.loops.sort();
  return found;
}

}  // namespace lacuna
