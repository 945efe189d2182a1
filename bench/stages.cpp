// SPDX-License-Identifier: Apache-2.0
// Measures the cost of each stage per point, alone, on one thread, on one tile of 65,536 points. There are 15
// neighbours, and every other parameter is at its default. Counter `per_point` is the time per point of the
// tile, comparable between stages and with a whole run. Counters of other names are per item that the stage
// goes through.
#include "bench/sample.hpp"
#include "bench/synth/ply_output.hpp"
#include "bench/synth/random.hpp"
#include "engine/boundary/coherence.hpp"
#include "engine/boundary/paper/cycles.hpp"
#include "engine/boundary/paper/eligible_edges.hpp"
#include "engine/boundary/paper/loops.hpp"
#include "engine/boundary/paper/spanning.hpp"
#include "engine/boundary/tangential/active_points.hpp"
#include "engine/bucket/cell_index.hpp"
#include "engine/bucket/order_tile.hpp"
#include "engine/bucket/split.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/evaluate.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/neighbours/block_search.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "engine/store/scratch.hpp"
#include "engine/survey/survey.hpp"
#include "io/files/new_file.hpp"
#include "io/scan/file_scan.hpp"
#include "tests/support/point_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <tuple>

#include <benchmark/benchmark.h>
#include <unistd.h>

namespace lacuna {
using namespace io;

namespace {

constexpr std::uint32_t kPoints = 65'536;
constexpr std::size_t kNeighbours = 15;
constexpr std::uint64_t kMemory = std::uint64_t{1} << 30;
constexpr std::uint64_t kBudget = std::uint64_t{1} << 30;

const Config kConfig;

void time_per(benchmark::State& state, const char* thing, std::size_t count) {
  state.counters[thing] =
      benchmark::Counter(static_cast<double>(count),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// ---- what the stages hand on, each computed once

const PointBatch& batch(SampleOrder order) {
  static const std::array batches{sample_surface(kPoints, SampleOrder::kScanline),
                                  sample_surface(kPoints, SampleOrder::kRandom)};
  return batches[order == SampleOrder::kRandom];
}

const TilePoints& tile() {
  static const TilePoints points = sample_tile(batch(SampleOrder::kScanline));
  return points;
}

const Neighbourhoods& neighbourhoods() {
  static const Neighbourhoods rows = lacuna::find_neighbourhoods(tile(), kNeighbours, 0);
  return rows;
}

const std::vector<Evaluation>& evaluations() {
  static const std::vector<Evaluation> all =
      lacuna::evaluate(tile(), neighbourhoods(), {}, kConfig.normals, kConfig.criteria);
  return all;
}

struct SampleCandidates {
  std::vector<Candidate> candidates;
  RowSet boundary{kPoints};
};

SampleCandidates candidates() {
  SampleCandidates sample;
  for (LocalIndex p = 0; p < tile().owned; ++p) {
    const Evaluation& e = evaluations()[p];
    if (!(e.probability > kConfig.coherence.threshold) || e.gap_near == kNoIndex) continue;
    sample.candidates.push_back({Row{p}, Row{e.gap_near}, Row{e.gap_far}});
    sample.boundary.insert(Row{p});
  }
  return sample;
}

// The eligible edges as a component of the global stage.
struct SampleComponent {
  std::vector<LocalIndex> vertices;  // in the tile, in ascending id
  std::vector<PointId> ids;          // of the vertices
  std::vector<LocalEdge> edges;      // between vertices, in ascending (weight, lower id, higher id)
  std::int64_t e;
};

SampleComponent component() {
  const TilePoints& points = tile();
  SampleComponent sample;
  std::vector<paper::TileEdge> edges =
      paper::eligible_edges(points, neighbourhoods(), evaluations(), kConfig.spanning).inside;
  for (const paper::TileEdge& edge : edges) {
    sample.vertices.push_back(edge.a);
    sample.vertices.push_back(edge.b);
  }
  const auto lower_id = [&](LocalIndex a, LocalIndex b) { return points.ids[a] < points.ids[b]; };
  std::sort(sample.vertices.begin(), sample.vertices.end(), lower_id);
  sample.vertices.erase(std::unique(sample.vertices.begin(), sample.vertices.end()), sample.vertices.end());

  for (const LocalIndex v : sample.vertices) sample.ids.push_back(points.ids[v]);
  std::vector<LocalIndex> vertex_of(points.size(), kNoIndex);
  for (std::size_t v = 0; v < sample.vertices.size(); ++v)
    vertex_of[sample.vertices[v]] = static_cast<LocalIndex>(v);
  for (paper::TileEdge& edge : edges) {
    const auto [low, high] = std::minmax({vertex_of[edge.a], vertex_of[edge.b]});
    edge = {low, high, edge.weight};
  }
  std::sort(edges.begin(), edges.end(), [](const paper::TileEdge& x, const paper::TileEdge& y) {
    return std::tie(x.weight, x.a, x.b) < std::tie(y.weight, y.a, y.b);
  });
  for (const paper::TileEdge& edge : edges) sample.edges.push_back({edge.a, edge.b});
  const double mean_neighbours =
      static_cast<double>(neighbourhoods().indices.size()) / static_cast<double>(points.owned);
  sample.e = std::llround(2 * std::sqrt(std::numbers::pi * mean_neighbours));
  return sample;
}

template <class Report>
void trace(const SampleComponent& component, Report&& report) {
  Scratch scratch(std::filesystem::temp_directory_path(), kBudget);
  paper::Spanning spanning(component.ids, component.e, scratch);
  for (const LocalEdge edge : component.edges) spanning.add(edge);
  paper::find_loops(paper::keep_cycles(spanning.finish(), scratch), scratch, report);
}

std::vector<Loop> loops() {
  const SampleComponent sample = component();
  std::vector<Loop> all;
  trace(sample, [&](std::span<const LocalIndex> found) {
    Loop& loop = all.emplace_back();
    for (const LocalIndex v : found) {
      const LocalIndex p = sample.vertices[v];
      const Evaluation& e = evaluations()[p];
      loop.push_back({tile().ids[p], tile().positions[p], e.mean_offset.cast<float>(),
                      static_cast<float>(e.probability)});
    }
  });
  return all;
}

// ---- from the input to the tile

// A file of 16 samples, so that the time to open it does not count.
class SampleFile {
 public:
  SampleFile()
      : path_(std::filesystem::temp_directory_path() /
              ("lacuna-stages-" + std::to_string(::getpid()) + ".ply")) {
    NewFile set(path_, synth::kScanMark, Overwrite::kOwn);
    synth::PlyOutput out(set.content(), synth::Coordinates::kFloat, synth::Extras::kNone);
    for (int copy = 0; copy < 16; ++copy) {
      for (const Eigen::Vector3d& p : batch(SampleOrder::kScanline).positions) out.add({p.x(), p.y(), p.z()});
    }
    rows_ = out.count();
    out.finish();
    set.commit();
  }
  ~SampleFile() { std::filesystem::remove(path_); }
  SampleFile(const SampleFile&) = delete;
  SampleFile& operator=(const SampleFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t rows() const { return rows_; }

 private:
  std::filesystem::path path_;
  std::uint64_t rows_ = 0;
};

void read_ply(benchmark::State& state) {
  const SampleFile file;
  FileScan scan({file.path()}, {});
  PointBatch read;
  for (auto _ : state) {
    scan.rewind();
    std::uint64_t rows = 0;
    while (scan.next(read)) rows += read.size();
    if (rows != file.rows()) state.SkipWithError("not all points were read");
  }
  time_per(state, "per_point", file.rows());
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(file.path())));
}
BENCHMARK(read_ply);

// Counts the points of 16 tiles, in batches of one tile. The first batch chooses the cell size, which costs
// more than counting it.
void survey(benchmark::State& state, SampleOrder order) {
  const PointBatch scan = sample_surface(16 * kPoints, order);
  std::vector<PointBatch> batches;
  for (auto at = scan.positions.begin(); at != scan.positions.end(); at += kPoints) {
    batches.push_back(
        {.first = PointId{kPoints * batches.size()}, .positions = {at, at + kPoints}, .normals = {}});
  }
  for (auto _ : state) {
    Survey survey(kMemory, scan.size());
    for (const PointBatch& points : batches) survey.add(points);
    benchmark::DoNotOptimize(survey.finish());
  }
  time_per(state, "per_point", scan.size());
}
BENCHMARK_CAPTURE(survey, scanline, SampleOrder::kScanline);
BENCHMARK_CAPTURE(survey, random, SampleOrder::kRandom);

// Points on their way to the tile store, and the cells that they are counted in.
struct UnorderedTile {
  explicit UnorderedTile(SampleOrder order) : points(batch(order)) {
    Survey survey(kMemory, kPoints);
    survey.add(points);
    SurveyedScan scan = survey.finish();
    plan = split_tiles(std::move(scan.cells), scan.grid, kPoints, kPoints);
    for (const Eigen::Vector3d& p : points.positions) {
      stored.push_back({p.x(), p.y(), p.z(), PointId{stored.size()}});
    }
  }

  std::vector<std::uint32_t> cells(const CellIndex& index) const {
    std::vector<std::uint32_t> cells(stored.size());
    index.find(points.positions, cells);
    return cells;
  }

  const PointBatch& points;
  TilePlan plan;
  std::vector<StoredPoint> stored;
};

void cell_of(benchmark::State& state, SampleOrder order) {
  const UnorderedTile unordered(order);
  const CellIndex index(unordered.plan.grid, unordered.plan.cells);
  for (auto _ : state) benchmark::DoNotOptimize(unordered.cells(index));
  time_per(state, "per_point", kPoints);
}
BENCHMARK_CAPTURE(cell_of, scanline, SampleOrder::kScanline);
BENCHMARK_CAPTURE(cell_of, random, SampleOrder::kRandom);

void order_tile(benchmark::State& state, SampleOrder order) {
  const UnorderedTile unordered(order);
  const std::vector<std::uint32_t> cells =
      unordered.cells(CellIndex(unordered.plan.grid, unordered.plan.cells));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        lacuna::order_tile(unordered.stored, cells, unordered.plan.cells.size(), unordered.plan.grid, 32));
  }
  time_per(state, "per_point", kPoints);
}
BENCHMARK_CAPTURE(order_tile, scanline, SampleOrder::kScanline);
BENCHMARK_CAPTURE(order_tile, random, SampleOrder::kRandom);

// ---- in the tile

void build_tree(benchmark::State& state) {
  for (auto _ : state) {
    const PointTree tree(tile().positions, tile().ids);
    benchmark::DoNotOptimize(&tree);
  }
  time_per(state, "per_point", kPoints);
}
BENCHMARK(build_tree);

void nearest(benchmark::State& state) {
  const PointTree tree(tile().positions, tile().ids);
  std::vector<Neighbour> found;
  for (auto _ : state) {
    for (LocalIndex p = 0; p < tile().owned; ++p) {
      tree.nearest(p, kNeighbours, found);
      benchmark::DoNotOptimize(found.data());
    }
  }
  time_per(state, "per_point", kPoints);
}
BENCHMARK(nearest);

void nearest_in_blocks(benchmark::State& state) {
  for (auto _ : state) {
    BlockSearch search(tile().positions, tile().ids);
    search.nearest(0, tile().owned, kNeighbours, [](LocalIndex, std::span<const LocalIndex> found) {
      benchmark::DoNotOptimize(found.data());
    });
  }
  time_per(state, "per_point", kPoints);
}
BENCHMARK(nearest_in_blocks);

void find_neighbourhoods(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(lacuna::find_neighbourhoods(tile(), kNeighbours, 0));
  time_per(state, "per_point", kPoints);
}
BENCHMARK(find_neighbourhoods);

void evaluate(benchmark::State& state) {
  neighbourhoods();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        lacuna::evaluate(tile(), neighbourhoods(), {}, kConfig.normals, kConfig.criteria));
  }
  time_per(state, "per_point", kPoints);
}
BENCHMARK(evaluate);

void eligible_edges(benchmark::State& state) {
  evaluations();
  std::size_t edges = 0;
  for (auto _ : state) {
    const paper::TileEdges found =
        paper::eligible_edges(tile(), neighbourhoods(), evaluations(), kConfig.spanning);
    edges = found.inside.size();
  }
  time_per(state, "per_point", kPoints);
  time_per(state, "per_eligible_edge", edges);
}
BENCHMARK(eligible_edges);

// The sample with every point moved up or down, by up to about this many spacings.
struct NoisySample {
  explicit NoisySample(double noise) {
    const synth::Random random(7, 1);
    const double most = noise * 1.5 * std::numbers::ln2 / std::sqrt(1.1 * kPoints);
    PointBatch moved = batch(SampleOrder::kScanline);
    for (std::size_t i = 0; i < moved.size(); ++i) moved.positions[i].z() += random.uniform(i, -most, most);
    points = sample_tile(moved);
    rows = lacuna::find_neighbourhoods(points, kNeighbours, 0);
    evaluations = lacuna::evaluate(points, rows, {}, kConfig.normals, kConfig.criteria);
    is_border.resize(points.owned);
    for (LocalIndex p = 0; p < points.owned; ++p) {
      if (evaluations[p].probability > kConfig.coherence.threshold) seeds.push_back(p);
    }
  }

  TilePoints points;
  Neighbourhoods rows;
  std::vector<Evaluation> evaluations;
  std::vector<LocalIndex> seeds;
  std::vector<std::uint8_t> is_border;  // no point is on a border
};

void find_stars(benchmark::State& state, double noise) {
  const NoisySample sample(noise);
  std::size_t vertices = 0;
  for (auto _ : state) {
    const tangential::TileStars found = tangential::find_stars(
        sample.points, sample.rows, sample.evaluations, sample.seeds, sample.is_border, kConfig.tangential);
    vertices = found.stars.vertices.size();
  }
  time_per(state, "per_point", kPoints);
  time_per(state, "per_link_vertex", vertices);
}
BENCHMARK_CAPTURE(find_stars, plain, 0.0);
BENCHMARK_CAPTURE(find_stars, noisy, 0.5);

// ---- the global stage

void remove_incoherent(benchmark::State& state) {
  const SampleCandidates sample = candidates();
  for (auto _ : state) {
    RowSet boundary = sample.boundary;  // 8 KiB
    benchmark::DoNotOptimize(lacuna::remove_incoherent(sample.candidates, boundary));
  }
  time_per(state, "per_point", kPoints);
  time_per(state, "per_candidate", sample.candidates.size());
}
BENCHMARK(remove_incoherent);

void span_and_find_loops(benchmark::State& state) {
  const SampleComponent sample = component();
  std::size_t found = 0;
  for (auto _ : state) {
    found = 0;
    trace(sample, [&](std::span<const LocalIndex>) { ++found; });
  }
  time_per(state, "per_point", kPoints);
  time_per(state, "per_eligible_edge", sample.edges.size());
  state.counters["loops"] = static_cast<double>(found);
}
BENCHMARK(span_and_find_loops);

void measure_loop(benchmark::State& state) {
  const std::vector<Loop> sample = loops();
  const double edge = 0.25;  // about 64 edges of the graph, as in a run
  std::size_t points = 0;
  for (const Loop& loop : sample) points += loop.size();
  for (auto _ : state) {
    for (const Loop& loop : sample) benchmark::DoNotOptimize(lacuna::measure_loop(loop, edge));
  }
  time_per(state, "per_point", kPoints);
  time_per(state, "per_loop_point", points);
}
BENCHMARK(measure_loop);

}  // namespace
}  // namespace lacuna

BENCHMARK_MAIN();
