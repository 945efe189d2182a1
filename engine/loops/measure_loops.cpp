#include "engine/loops/measure_loops.hpp"

#include "engine/run/error.hpp"
#include "engine/store/outbox.hpp"
#include "engine/store/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lacuna {
namespace {

// A place among the points of all loops, and the point that belongs there.
struct Wanted {
  Row row;
  std::uint64_t place;
};

using WantedLists = AppendLists<Wanted>;

WantedLists wanted_points(const RawLoops& loops, const Tiling& tiling, const Job& job) {
  WantedLists wanted(job.file("wanted-loop-points"), tiling.tiles.size(), job.memory.spills / 4);
  Outbox<Wanted> outbox(wanted);
  std::uint64_t place = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    loops.for_each_vertex(i, [&](const Vertex& v) {
      outbox.add(tiling.tile_of_row(v.row), {v.row, place++});
    });
  }
  outbox.send();
  return wanted;
}

// Puts the points of a tile into their places.
void place_points(std::vector<Wanted> wanted, std::span<const StoredVertex> vertices, const Tile& tile,
                  Column<StoredLoopPoint>& points) {
  std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) { return a.place < b.place; });
  std::vector<StoredLoopPoint> run;  // of consecutive places
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const LocalIndex owned = tile.local(wanted[i].row);
    const auto vertex = std::lower_bound(vertices.begin(), vertices.end(), owned,
                                         [](const StoredVertex& v, LocalIndex p) { return v.owned < p; });
    if (vertex == vertices.end() || vertex->owned != owned)
      fail_inconsistent("a loop passes through a point that was not kept");
    run.push_back({vertex->point,
                   wanted[i].row,
                   {vertex->surface[0], vertex->surface[1], vertex->surface[2]},
                   vertex->probability});
    if (i + 1 < wanted.size() && wanted[i + 1].place == wanted[i].place + 1) continue;
    points.write(wanted[i].place + 1 - run.size(), run);
    run.clear();
  }
}

// Cubes of 64 mean edges, as a power of two.
double lattice_edge(double mean_edge_length) {
  return std::ldexp(1.0, std::ilogb(64 * mean_edge_length));
}

}  // namespace

void MeasuredLoops::for_each_point(std::size_t loop,
                                   const std::function<void(const StoredLoopPoint&)>& visit) const {
  ColumnReader<StoredLoopPoint> reader(points);
  for (std::uint64_t i = offsets[loop]; i < offsets[loop + 1]; ++i) visit(reader[i]);
}

MeasuredLoops measure_loops(const RawLoops& loops, const LoopPointLists& lists, const Tiling& tiling,
                            double mean_edge_length, Job& job) {
  Phase phase(job, "measure", loops.points());
  MeasuredLoops measured{.points = Column<StoredLoopPoint>(job.file("loops")), .offsets = {0}};
  const WantedLists wanted = wanted_points(loops, tiling, job);
  job.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    if (wanted.count(t) > 0) place_points(wanted.read(t), lists.read(t), tiling.tiles[t], measured.points);
  });

  std::vector<std::uint64_t> needs;
  const std::uint64_t most = job.memory.global / (2 * job.arena.threads());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    measured.offsets.push_back(measured.offsets.back() + loops.points(i));
    needs.push_back(std::min(most, 2 * loops.points(i) * sizeof(StoredLoopPoint)));
  }
  measured.measures.resize(loops.size());
  const double edge = lattice_edge(mean_edge_length);
  job.arena.for_each_within_budget(needs, job.memory.global, [&](std::size_t i) {
    Scratch scratch(job.workspace, most);
    const std::span<StoredLoopPoint> loop = scratch.array<StoredLoopPoint>(loops.points(i));
    measured.points.read(measured.offsets[i], loop);
    measured.measures[i] = measure_loop(loop, edge, scratch);
    measured.measures[i].confidence = loops.rating(i).confidence;
    phase.advance(loop.size());
  });
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
