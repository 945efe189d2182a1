#include "engine/passes/trace.hpp"

#include "engine/stages/loops.hpp"
#include "engine/stages/order_edges.hpp"
#include "engine/stages/settle_part.hpp"
#include "engine/stages/spanning.hpp"
#include "engine/stages/union_find.hpp"
#include "engine/store/row_numbers.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <atomic>

namespace lacuna {
namespace {

// An eligible edge between tiles, told to both.
struct SeamEdge {
  LocalIndex owned;
  Vertex own, foreign;
  double weight;
};

// Two ends of seam edges that are in one component.
struct Join {
  Row a, b;
};

// A part of a component, inside one tile. It goes by an end of a seam edge, a row that no other part has.
struct OpenPart {
  Row name;
  std::uint64_t edges;  // told by this tile
};

// Measured: edges, vertices and graph of a component while it is traced.
constexpr std::uint64_t kBytesPerEdge = 120;

// Of a tile.
constexpr std::uint64_t kBytesPerVertex = 280;

ComponentEdge component_edge(std::uint64_t component, double weight, const Vertex& a, const Vertex& b) {
  return a.id < b.id ? ComponentEdge{component, weight, a, b} : ComponentEdge{component, weight, b, a};
}

// ---- seams: crossings judged with Pi and r of both ends

void judge_crossings(EvaluatedScan& scan, const Tiling& tiling, TileIndex t, const SpanningConfig& config,
                     AppendLists<SeamEdge>& seams) {
  std::vector<StoredCrossing> crossings = scan.edges.crossings.read(t);
  scan.edges.crossings.drop(t);
  std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
    return a.foreign.row != b.foreign.row ? a.foreign.row < b.foreign.row : a.own.row < b.own.row;
  });
  ColumnReader<Strength> foreign(scan.edges.strengths);
  std::vector<SeamEdge> here;
  for (const StoredCrossing& c : crossings) {
    const Strength& other = foreign[value(c.foreign.row)];
    // Both ends tell if both are strong: then the lower id's word counts.
    if (is_strong(other.probability, config) && c.foreign.id < c.own.id) continue;
    const double weight = eligible_weight(c.strength, other, c.distance, config);
    if (weight < 0) continue;
    here.push_back({tiling.tiles[t].local(c.own.row), c.own, c.foreign, weight});
    const TileIndex there = tiling.tile_of_row(c.foreign.row);
    seams.append(there, {tiling.tiles[there].local(c.foreign.row), c.foreign, c.own, weight});
  }
  seams.append(t, here);
}

// ---- one component

// row_of(v): of a vertex of the graph.
template <class RowOf>
void trace(const SpanningGraph& graph, RowOf&& row_of, Scratch& scratch, RawLoops& loops) {
  std::vector<Vertex> loop;
  find_loops(graph, scratch, [&](std::span<const LocalIndex> found) {
    loop.clear();
    for (const LocalIndex v : found) loop.push_back({graph.ids[v], row_of(v)});
    loops.add(loop, kNoConfidence);
  });
}

// Vertices are numbered by row: near in space, near in memory.
void trace_in_memory(std::span<const ComponentEdge> edges, std::int64_t e, const Job& job, RawLoops& loops) {
  if (edges.size() <= static_cast<std::uint64_t>(e)) return;  // a loop has more
  RowNumbers rows;
  rows.collect(edges.size(), [&](auto&& add) {
    for (const ComponentEdge& edge : edges) {
      add(edge.a.row);
      add(edge.b.row);
    }
  });
  if (rows.size() <= static_cast<std::uint64_t>(e)) return;
  std::vector<PointId> ids(rows.size());
  std::vector<WeightedEdge> sorted;
  sorted.reserve(edges.size());
  for (const ComponentEdge& edge : edges) {
    const LocalIndex a = rows.number(edge.a.row), b = rows.number(edge.b.row);
    ids[a] = edge.a.id;
    ids[b] = edge.b.id;
    sorted.push_back({a, b, edge.weight});
  }
  order_edges(sorted, ids);
  Scratch scratch(job.workspace, job.memory.limit);
  Spanning spanning(ids, e, scratch);
  for (const WeightedEdge& edge : sorted) spanning.add({edge.a, edge.b});
  std::vector<WeightedEdge>().swap(sorted);
  trace(
      spanning.finish(), [&](LocalIndex v) { return rows.row(v); }, scratch, loops);
}

// `edges`: of whole components, in any order.
void trace_components(std::vector<ComponentEdge>& edges, std::int64_t e, const Job& job, RawLoops& loops) {
  const auto by_component = [](const ComponentEdge& x, const ComponentEdge& y) {
    return x.component < y.component;
  };
  if (!std::is_sorted(edges.begin(), edges.end(), by_component))
    std::sort(edges.begin(), edges.end(), by_component);
  for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
    for (end = begin; end < edges.size() && edges[end].component == edges[begin].component;) ++end;
    trace_in_memory(std::span(edges).subspan(begin, end - begin), e, job, loops);
  }
}

// One component that does not fit in memory. for_each_edge(visit): its edges in any order, twice.
void trace_on_disk(const std::function<void(const std::function<void(const ComponentEdge&)>&)>& for_each_edge,
                   std::uint64_t edge_count, std::int64_t e, const Job& job, RawLoops& loops) {
  RowNumbers rows;
  rows.collect(edge_count, [&](auto&& add) {
    for_each_edge([&](const ComponentEdge& edge) {
      add(edge.a.row);
      add(edge.b.row);
    });
  });
  SortedRuns<ComponentEdge> sorted(job.file("large-edges"), job.memory.global / 4);
  Scratch scratch(job.workspace, job.memory.global * 5 / 8);
  const std::span<PointId> ids = scratch.array<PointId>(rows.size());
  for_each_edge([&](const ComponentEdge& edge) {
    scratch.trim();
    sorted.add(edge);
    ids[rows.number(edge.a.row)] = edge.a.id;
    ids[rows.number(edge.b.row)] = edge.b.id;
  });
  Spanning spanning(ids, e, scratch);
  sorted.for_each([&](const ComponentEdge& edge) {
    spanning.add({rows.number(edge.a.row), rows.number(edge.b.row)});
  });
  trace(
      spanning.finish(), [&](LocalIndex v) { return rows.row(v); }, scratch, loops);
}

// ---- components

template <class T>
void sort_once(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// The vertices that a tile knows of: its own ends of eligible edges, in ascending row, then those of other
// tiles at the ends of its seam edges.
class TileVertices {
 public:
  TileVertices(const Tile& tile, std::span<const StoredVertex> own, std::span<const SeamEdge> seams)
      : own_(static_cast<LocalIndex>(own.size())), numbers_(tile.points) {
    for (LocalIndex v = 0; v < own_; ++v) {
      numbers_[own[v].owned] = v;
      rows_.push_back(tile.row(own[v].owned));
      ids_.push_back(own[v].point.id);
    }
    for (const SeamEdge& seam : seams) foreign_.push_back(seam.foreign.row);
    sort_once(foreign_);
    rows_.insert(rows_.end(), foreign_.begin(), foreign_.end());
    ids_.resize(rows_.size());
    for (const SeamEdge& seam : seams) ids_[foreign(seam)] = seam.foreign.id;
  }

  PartVertices part() const { return {ids_, own_}; }
  LocalIndex own(LocalIndex point) const { return numbers_[point]; }
  LocalIndex foreign(const SeamEdge& seam) const {
    const auto at = std::lower_bound(foreign_.begin(), foreign_.end(), seam.foreign.row);
    return own_ + static_cast<LocalIndex>(at - foreign_.begin());
  }
  Vertex operator[](LocalIndex v) const { return {ids_[v], rows_[v]}; }

 private:
  LocalIndex own_;
  std::vector<LocalIndex> numbers_;  // of the tile's points; of those that are no vertex: any
  std::vector<Row> rows_, foreign_;
  std::vector<PointId> ids_;
};

class Tracer {
 public:
  Tracer(EvaluatedScan& scan, const TileStore& store, std::int64_t e, Job& job)
      : scan_(scan),
        store_(store),
        e_(e),
        job_(job),
        tiles_(store.tiling().tiles.size()),
        seams_(job.file("seams"), tiles_, job.memory.spills / 8),
        open_edges_(job.file("open-edges"), tiles_, job.memory.spills / 8),
        joins_(job.file("joins"), tiles_, job.memory.spills / 8),
        open_parts_(job.file("open-parts"), tiles_, job.memory.spills / 8),
        traced_{RawLoops(job.file("raw-loops"))} {}

  TracedLoops run() {
    job_.crew.for_each(tiles_, [&](std::size_t t) {
      judge_crossings(scan_, store_.tiling(), static_cast<TileIndex>(t), job_.config.spanning, seams_);
    });
    std::vector<std::uint64_t> needs(tiles_);
    for (std::size_t t = 0; t < tiles_; ++t) {
      needs[t] = (scan_.edges.inside.count(t) + seams_.count(t)) * kBytesPerEdge +
                 scan_.vertices.count(t) * kBytesPerVertex +
                 store_.tiling().tiles[t].points * sizeof(LocalIndex);
    }
    job_.crew.for_each_within(needs, job_.memory.global,
                              [&](std::size_t t) { trace_tile(static_cast<TileIndex>(t)); });
    trace_open_components();
    traced_.eligible_edges = eligible_edges_;
    traced_.components = components_;
    traced_.loops.sort();
    return std::move(traced_);
  }

 private:
  // Loops that nothing outside of the tile has to do with are found here; what may matter elsewhere goes on.
  void trace_tile(TileIndex t) {
    const Tile& tile = store_.tiling().tiles[t];
    std::vector<WeightedEdge> edges = scan_.edges.inside.read(t);
    scan_.edges.inside.drop(t);
    const std::vector<SeamEdge> seams = seams_.read(t);
    if (edges.empty() && seams.empty()) return;
    const TileVertices vertices(tile, scan_.vertices.read(t), seams);
    for (WeightedEdge& edge : edges) edge = {vertices.own(edge.a), vertices.own(edge.b), edge.weight};
    for (const SeamEdge& seam : seams)
      edges.push_back({vertices.own(seam.owned), vertices.foreign(seam), seam.weight});
    eligible_edges_ += static_cast<std::uint64_t>(std::count_if(
        edges.begin(), edges.end(), [&](const WeightedEdge& edge) { return vertices.part().tells(edge); }));

    Scratch scratch(job_.workspace, job_.memory.limit);
    const SettledPart part = settle_part(vertices.part(), std::move(edges), e_, scratch);
    trace(
        part.settled, [&](LocalIndex v) { return vertices[v].row; }, scratch, traced_.loops);
    UnionFind connected(part.links);
    components_ += closed_components(vertices.part(), connected);
    pass_on(t, vertices, connected, part.passed_on, seams);
  }

  // Components with an edge, but none to another tile.
  static std::uint64_t closed_components(const PartVertices& vertices, UnionFind& connected) {
    enum : std::uint8_t { kHasEdge = 1, kIsOpen = 2 };
    std::vector<std::uint8_t> roots(vertices.size());
    for (LocalIndex v = 0; v < vertices.size(); ++v) {
      const LocalIndex root = connected.find(v);
      if (root != v) roots[root] |= kHasEdge;
      if (v >= vertices.owned) roots[root] |= kIsOpen;
    }
    return static_cast<std::uint64_t>(std::count(roots.begin(), roots.end(), kHasEdge));
  }

  // `edges`: of parts that seam edges leave.
  void pass_on(TileIndex t, const TileVertices& vertices, UnionFind& connected,
               std::span<const WeightedEdge> edges, std::span<const SeamEdge> seams) {
    std::vector<LocalIndex> part_of(vertices.part().size(), kNoIndex);  // of a root
    std::vector<OpenPart> open_parts;
    std::vector<Join> joins;
    for (const SeamEdge& seam : seams) {
      LocalIndex& part = part_of[connected.find(vertices.own(seam.owned))];
      if (part == kNoIndex) {
        part = static_cast<LocalIndex>(open_parts.size());
        open_parts.push_back({seam.own.row, 0});
      }
      joins.push_back({open_parts[part].name, seam.own.row});
      if (seam.own.id < seam.foreign.id) joins.push_back({seam.own.row, seam.foreign.row});
    }
    std::vector<ComponentEdge> open_edges;
    for (const WeightedEdge& edge : edges) {
      const LocalIndex part = part_of[connected.find(edge.a)];
      ++open_parts[part].edges;
      open_edges.push_back(component_edge(part, edge.weight, vertices[edge.a], vertices[edge.b]));
    }
    open_edges_.append(t, open_edges);
    open_parts_.append(t, open_parts);
    joins_.append(t, joins);
  }

  void trace_open_components() {
    std::uint64_t joins = 0;
    for (std::size_t t = 0; t < tiles_; ++t) joins += joins_.count(t);
    if (joins == 0) return;
    Scratch scratch(job_.workspace, job_.memory.global / 3);
    const std::span<Row> ends = seam_ends(scratch);
    const auto end_of = [&](Row row) {
      scratch.trim();
      return static_cast<LocalIndex>(std::lower_bound(ends.begin(), ends.end(), row) - ends.begin());
    };
    UnionFind components(scratch.array<LocalIndex>(ends.size()));
    for (std::size_t t = 0; t < tiles_; ++t) {
      for (const Join& join : joins_.read(t)) components.unite(end_of(join.a), end_of(join.b));
    }

    const std::span<std::uint64_t> edge_counts = scratch.array<std::uint64_t>(ends.size());
    const std::span<LocalIndex> component_of = scratch.array<LocalIndex>(ends.size());  // by part
    std::vector<std::uint64_t> first_part;                                              // by tile
    std::uint64_t parts = 0;
    for (std::size_t t = 0; t < tiles_; ++t) {
      first_part.push_back(parts);
      for (const OpenPart& part : open_parts_.read(t)) {
        const LocalIndex component = components.find(end_of(part.name));
        edge_counts[component] += part.edges;
        component_of[parts++] = component;
      }
    }

    // Batches of whole components, as many as fit.
    const std::uint64_t most =
        std::max<std::uint64_t>(job_.memory.global / 2 / kBytesPerEdge / job_.crew.threads(), 1);
    const std::span<std::uint32_t> batch_of = scratch.array<std::uint32_t>(ends.size());
    std::vector<std::uint64_t> batch_edges;
    for (std::size_t c = 0; c < ends.size(); ++c) {
      scratch.trim();
      components_ += components.find(static_cast<LocalIndex>(c)) == c;
      if (edge_counts[c] == 0) continue;
      if (batch_edges.empty() || batch_edges.back() + edge_counts[c] > most) batch_edges.push_back(0);
      batch_edges.back() += edge_counts[c];
      batch_of[c] = static_cast<std::uint32_t>(batch_edges.size() - 1);
    }
    AppendLists<ComponentEdge> batches(job_.file("batches"), batch_edges.size(), job_.memory.spills / 4);
    job_.crew.for_each(tiles_, [&](std::size_t t) {
      std::vector<ComponentEdge> edges = open_edges_.read(t);
      open_edges_.drop(t);
      for (ComponentEdge& edge : edges) edge.component = component_of[first_part[t] + edge.component];
      append_batches(edges, batch_of, batches);
    });

    const std::uint64_t fits = job_.memory.global / 2 / kBytesPerEdge;
    std::vector<std::uint64_t> needs(batch_edges.size());
    for (std::size_t b = 0; b < needs.size(); ++b)
      needs[b] = batch_edges[b] > fits ? 0 : batch_edges[b] * kBytesPerEdge;
    job_.crew.for_each_within(needs, job_.memory.global / 2, [&](std::size_t b) {
      if (batch_edges[b] > fits) return;
      std::vector<ComponentEdge> edges = batches.read(b);
      batches.drop(b);
      trace_components(edges, e_, job_, traced_.loops);
    });
    for (std::size_t b = 0; b < needs.size(); ++b) {
      if (batch_edges[b] > fits) {
        trace_on_disk([&](const auto& visit) { batches.for_each(b, visit); }, batch_edges[b], e_, job_,
                      traced_.loops);
      }
    }
  }

  static void append_batches(std::vector<ComponentEdge>& edges, std::span<const std::uint32_t> batch_of,
                             AppendLists<ComponentEdge>& batches) {
    const auto batch = [&](const ComponentEdge& edge) { return batch_of[edge.component]; };
    std::sort(edges.begin(), edges.end(),
              [&](const ComponentEdge& x, const ComponentEdge& y) { return batch(x) < batch(y); });
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
      for (end = begin; end < edges.size() && batch(edges[end]) == batch(edges[begin]);) ++end;
      batches.append(batch(edges[begin]), std::span(edges).subspan(begin, end - begin));
    }
  }

  // Rows at the ends of seam edges, ascending, each once.
  std::span<Row> seam_ends(Scratch& scratch) {
    std::uint64_t most = 0;
    for (std::size_t t = 0; t < tiles_; ++t) most += seams_.count(t);
    const std::span<Row> ends = scratch.array<Row>(most);
    std::size_t count = 0;
    std::vector<Row> rows;
    for (std::size_t t = 0; t < tiles_; ++t) {
      rows.clear();
      for (const SeamEdge& seam : seams_.read(t)) rows.push_back(seam.own.row);
      seams_.drop(t);
      sort_once(rows);
      for (const Row row : rows) {
        ends[count++] = row;
        scratch.trim();
      }
    }
    return ends.first(count);
  }

  EvaluatedScan& scan_;
  const TileStore& store_;
  std::int64_t e_;
  Job& job_;
  std::size_t tiles_;
  AppendLists<SeamEdge> seams_;
  AppendLists<ComponentEdge> open_edges_;
  AppendLists<Join> joins_;
  AppendLists<OpenPart> open_parts_;
  TracedLoops traced_;
  std::atomic<std::uint64_t> eligible_edges_ = 0, components_ = 0;
};

}  // namespace

TracedLoops trace_loops(EvaluatedScan& scan, const TileStore& store, std::int64_t e, Job& job) {
  Phase phase(job, "loops", 0);
  return Tracer(scan, store, e, job).run();
}

}  // namespace lacuna
