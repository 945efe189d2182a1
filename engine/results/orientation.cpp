// SPDX-License-Identifier: Apache-2.0
#include "engine/results/orientation.hpp"

#include "engine/stitch/components.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacuna {
namespace {

Eigen::Vector3d vector(const PlainNormal& n) {
  return Eigen::Vector3d(n.data());
}

// Disjoint sets of rows that know for each row whether its normal opposes the normal of its root.
class SignedUnionFind {
 public:
  SignedUnionFind(std::uint64_t rows, Scratch& scratch)
      : scratch_(scratch), links_(scratch.array<std::uint64_t>(rows)) {}

  struct SignedRoot {
    std::uint64_t root;
    bool opposed;
  };

  SignedRoot find(std::uint64_t x) {
    scratch_.trim();
    bool opposed = false;
    while (links_[x] != 0) {
      const std::uint64_t up = parent(x);
      if (links_[up] != 0) links_[x] = link(parent(up), sign(x) != sign(up));
      opposed ^= sign(x);
      x = parent(x);
    }
    return {x, opposed};
  }

  void unite(std::uint64_t a, std::uint64_t b, bool opposed) {
    const SignedRoot at_a = find(a), at_b = find(b);
    if (at_a.root == at_b.root) return;
    const auto [low, high] = std::minmax(at_a.root, at_b.root);
    links_[high] = link(low, (at_a.opposed != at_b.opposed) != opposed);
  }

 private:
  // Parent + 1 and the sign in the lowest bit; 0: a root.
  static std::uint64_t link(std::uint64_t parent, bool opposed) { return (parent + 1) << 1 | opposed; }
  std::uint64_t parent(std::uint64_t x) const { return (links_[x] >> 1) - 1; }
  bool sign(std::uint64_t x) const { return links_[x] & 1; }

  Scratch& scratch_;
  std::span<std::uint64_t> links_;
};

using EdgeSort = SortedRuns<OrientationEdge>;

// The data that a tile emits.
constexpr RecordStream<PlainNormal> kNormals{"normals"};
constexpr RecordStream<OrientationEdge> kForest{"orientation"};
constexpr RecordStream<OrientationCrossing> kCrossings{"orientation crossings"};

void add_crossings(std::vector<OrientationCrossing> crossings, const Column<PlainNormal>& normals,
                   const TileStore& store, TileIndex t, EdgeSort& edges) {
  if (crossings.empty()) return;
  std::sort(crossings.begin(), crossings.end(),
            [](const auto& a, const auto& b) { return a.foreign < b.foreign; });
  const Tile& tile = store.tiling().tiles[t];
  const std::vector<ScanPoint> points = store.points(t);
  const std::vector<PlainNormal> own = normals.read(value(tile.first_row), tile.points);
  ColumnReader<PlainNormal> foreign(normals);
  for (const OrientationCrossing& c : crossings) {
    const Eigen::Vector3d other = vector(foreign[value(c.foreign)]);
    if (!other.allFinite()) continue;
    edges.add(orientation_edge({points[c.owned].id, tile.row(c.owned), vector(own[c.owned])},
                               {c.foreign_id, c.foreign, other}));
  }
}

bool points_down(const PlainNormal& n) {
  if (n[2] != 0) return n[2] < 0;
  return n[1] != 0 ? n[1] < 0 : n[0] < 0;
}

}  // namespace

OrientationEdge orientation_edge(const OrientedEnd& a, const OrientedEnd& b) {
  const bool a_first = a.id < b.id;
  const OrientedEnd& low = a_first ? a : b;
  const OrientedEnd& high = a_first ? b : a;
  const double cosine = (low.normal.x() * high.normal.x() + low.normal.y() * high.normal.y()) +
                        low.normal.z() * high.normal.z();
  return {.weight = 1 - std::abs(cosine),
          .low_id = low.id,
          .high_id = high.id,
          .low = low.row,
          .high = high.row,
          .opposed = cosine < 0};
}

std::vector<OrientationEdge> spanning_forest(std::vector<OrientationEdge> edges, std::uint64_t first_row,
                                             LocalIndex rows) {
  std::sort(edges.begin(), edges.end());
  std::vector<LocalIndex> parents(rows);
  UnionFind trees(parents);
  const auto local = [&](Row row) { return static_cast<LocalIndex>(value(row) - first_row); };
  std::erase_if(edges, [&](const OrientationEdge& e) { return !trees.unite(local(e.low), local(e.high)); });
  return edges;
}

void emit_orientation(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<PlainNormal> normals;
  for (const Evaluation& e : tile.evaluations) normals.push_back({e.normal.x(), e.normal.y(), e.normal.z()});
  output.add(kNormals, std::move(normals));

  std::vector<OrientationEdge> edges;
  std::vector<OrientationCrossing> crossings;
  const TilePoints& points = tile.points;
  const auto end = [&](LocalIndex p) {
    return OrientedEnd{points.ids[p], points.rows[p], tile.evaluations[p].normal};
  };
  for (LocalIndex p = 0; p < points.owned; ++p) {
    if (!tile.evaluations[p].normal.allFinite()) continue;
    for (const LocalIndex q : tile.neighbourhoods[p]) {
      if (!(points.ids[p] < points.ids[q])) continue;
      if (!points.is_owned(q)) {
        crossings.push_back({p, points.rows[q], points.ids[q]});
      } else if (tile.evaluations[q].normal.allFinite()) {
        edges.push_back(orientation_edge(end(p), end(q)));
      }
    }
  }
  output.add(kForest, spanning_forest(std::move(edges), value(tile.tile.first_row), points.owned));
  output.add(kCrossings, std::move(crossings));
}

RowSet opposed_normals(const TileOutputs& outputs, const TileStore& store, const Spill& spill,
                       const Workers& workers, Phases& phases) {
  const Tiling& tiling = store.tiling();
  Phase phase(phases, "orient", tiling.points());
  Column<PlainNormal> normals_by_row(spill.file("oriented-normals"));
  workers.arena.for_each(tiling.tiles.size(), [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    normals_by_row.write(value(tiling.tiles[t].first_row), outputs.read(kNormals, t));
  });
  const MemoryLedger::Lease sorting = workers.memory.ledger.take(workers.memory.work / 3);
  EdgeSort edges(spill.file("orientation-edges"), sorting.bytes());
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    for (const OrientationEdge& edge : outputs.read(kForest, t)) edges.add(edge);
    add_crossings(outputs.read(kCrossings, t), normals_by_row, store, t, edges);
    phase.advance(tiling.tiles[t].points);
  }

  const MemoryLedger::Lease spanning = workers.memory.ledger.take(workers.memory.work / 2);
  Scratch scratch(spill.folder, spanning.bytes());
  const std::uint64_t rows = tiling.row_count();
  SignedUnionFind trees(rows, scratch);
  edges.for_each([&](const OrientationEdge& e) { trees.unite(value(e.low), value(e.high), e.opposed); });

  // The topmost point of a tree. The root's normal may have to be turned for the normal of that point to
  // point up.
  struct Top {
    double z;
    std::uint64_t id;
    std::uint32_t is_set, turn_root;
  };
  const std::span<Top> tops = scratch.array<Top>(rows);
  const auto for_each_normal = [&](auto&& visit) {
    for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
      const std::uint64_t first = value(tiling.tiles[t].first_row);
      const std::vector<ScanPoint> points = store.points(t);
      const std::vector<PlainNormal> normals = normals_by_row.read(first, points.size());
      for (std::size_t p = 0; p < points.size(); ++p) {
        if (vector(normals[p]).allFinite()) visit(first + p, points[p], normals[p]);
      }
    }
  };
  for_each_normal([&](std::uint64_t row, const ScanPoint& point, const PlainNormal& normal) {
    const auto [root, opposed] = trees.find(row);
    Top& top = tops[root];
    const bool higher = point.z != top.z ? point.z > top.z : value(point.id) < top.id;
    if (!top.is_set || higher) top = {point.z, value(point.id), 1, opposed != points_down(normal)};
  });
  RowSet turned(rows);
  for_each_normal([&](std::uint64_t row, const ScanPoint&, const PlainNormal&) {
    const auto [root, opposed] = trees.find(row);
    if (opposed != (tops[root].turn_root != 0)) turned.insert(Row{row});
  });
  return turned;
}

}  // namespace lacuna
