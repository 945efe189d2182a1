#include "engine/loops/measure_loops.hpp"

#include "engine/loops/measure_loop.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

namespace lacuna {
namespace {

// A place on a loop that needs its point.
struct Wanted {
  Row row;
  std::size_t slot;
};

Loop to_loop(std::span<const StoredLoopPoint> stored) {
  Loop loop;
  loop.reserve(stored.size());
  for (const StoredLoopPoint& p : stored) {
    loop.push_back(
        {p.point.id, p.row, p.point.position(), {p.surface[0], p.surface[1], p.surface[2]}, p.probability});
  }
  return loop;
}

// Joins what is wanted of a tile with its vertices.
void gather(std::vector<Wanted> wanted, const LoopPointLists& lists, const Tiling& tiling, TileIndex t,
            std::span<StoredLoopPoint> points) {
  if (wanted.empty()) return;
  std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) { return a.row < b.row; });
  const std::vector<StoredVertex> vertices = lists.read(t);
  auto vertex = vertices.begin();
  for (const Wanted& w : wanted) {
    const auto owned = tiling.tiles[t].local(w.row);
    vertex = std::lower_bound(vertex, vertices.end(), owned,
                              [](const StoredVertex& v, LocalIndex p) { return v.owned < p; });
    assert(vertex != vertices.end() && vertex->owned == owned);
    points[w.slot] = {vertex->point,
                      w.row,
                      {vertex->surface[0], vertex->surface[1], vertex->surface[2]},
                      vertex->probability};
  }
}

// Cubes of 64 mean edges, as a power of two.
double lattice_edge(double mean_edge_length) {
  return std::ldexp(1.0, std::ilogb(64 * mean_edge_length));
}

}  // namespace

Loop MeasuredLoops::read(std::size_t loop) const {
  return to_loop(points.read(offsets[loop], offsets[loop + 1] - offsets[loop]));
}

MeasuredLoops measure_loops(const RawLoops& loops, const LoopPointLists& lists, const Tiling& tiling,
                            double mean_edge_length, Job& job) {
  Phase phase(job, "measure", loops.points());
  MeasuredLoops measured{.points = Column<StoredLoopPoint>(job.file("loops")), .offsets = {0}};
  measured.measures.resize(loops.size());
  const double edge = lattice_edge(mean_edge_length);
  const std::uint64_t most = job.memory.global / (2 * sizeof(StoredLoopPoint) + 2 * sizeof(Wanted));
  for (std::size_t begin = 0, end; begin < loops.size(); begin = end) {
    std::vector<std::vector<Wanted>> wanted(tiling.tiles.size());
    std::size_t count = 0;
    for (end = begin; end < loops.size() && (end == begin || count + loops.points(end) <= most); ++end) {
      for (const Vertex& v : loops.read(end)) wanted[tiling.tile_of_row(v.row)].push_back({v.row, count++});
      measured.offsets.push_back(measured.offsets.back() + loops.points(end));
    }
    const std::uint64_t first = measured.offsets[begin];
    const auto memory = std::make_unique_for_overwrite<StoredLoopPoint[]>(count);
    const std::span<StoredLoopPoint> points(memory.get(), count);
    job.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
      gather(std::move(wanted[t]), lists, tiling, static_cast<TileIndex>(t), points);
    });
    measured.points.write(first, points);
    job.arena.for_each(end - begin, [&](std::size_t i) {
      const std::uint64_t from = measured.offsets[begin + i] - first;
      const Loop loop = to_loop(points.subspan(from, loops.points(begin + i)));
      measured.measures[begin + i] = measure_loop(loop, edge);
      measured.measures[begin + i].confidence = loops.rating(begin + i).confidence;
    });
    phase.advance(points.size());
  }
  return measured;
}

std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config) {
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopMeasures& loop = loops[i];
    const bool too_short = loop.perimeter < config.min_perimeter;
    const bool too_long = config.max_perimeter > 0 && loop.perimeter > config.max_perimeter;
    const bool too_small = loop.diameter < config.min_diameter;
    const bool too_few = loop.points < static_cast<std::uint64_t>(config.min_points);
    const bool unwanted = config.holes_only && loop.kind == LoopKind::kOuter;
    if (!too_short && !too_long && !too_small && !too_few && !unwanted) selected.push_back(i);
  }
  return selected;
}

}  // namespace lacuna
