// SPDX-License-Identifier: Apache-2.0
#include "engine/run_needs.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/levels/level.hpp"
#include "engine/model/orientation.hpp"
#include "engine/results/point_results.hpp"
#include "engine/results/probability_voxels.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/thin/choose_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lacuna {
namespace {

// A tile has some sqrt(points) points along its border. These are bytes for each of them: of lists between
// tiles (halo edges, belts, open stars), and of what belts have on disk only. They were measured on jittered
// and random surfaces and on scans, from 40,000 to 4 million points. The largest is twice the smallest.
constexpr double kListBytes = 12'000, kBeltBytes = 4'500;
// Bytes for each point of a tile at work. Measured as above; stars around candidates take more.
constexpr double kPointAtWork = 390, kCandidateAtWork = 400, kOrientedAtWork = 300;
constexpr std::uint64_t kProgram = 18 << 20;  // while tiles are evaluated
constexpr std::uint64_t kSpreadResult = 72;   // of a point that another one represents
constexpr std::uint64_t kKeptBytes = 80;      // of a point, in the outputs of its tile: on rough surfaces
constexpr double kLevelAbove = 0.65;          // points of the level above the first one, for one of that

std::uint64_t beyond(std::uint64_t bytes, std::uint64_t budget) {
  return bytes > budget ? bytes - budget : 0;
}

// A sort that does not fit in memory is on disk as a whole.
std::uint64_t sorted_on_disk(std::uint64_t bytes, std::uint64_t budget) {
  return bytes > budget ? bytes : 0;
}

// Tiles are halves of halves.
double points_of_a_tile(const RunSize& size) {
  if (size.points == 0) return 1;
  const std::uint64_t least = (size.points + size.tile_points - 1) / size.tile_points;
  return static_cast<double>(size.points) / static_cast<double>(std::bit_ceil(least));
}

std::uint64_t border_bytes(const RunSize& size, double bytes) {
  return static_cast<std::uint64_t>(static_cast<double>(size.points) * bytes /
                                    std::sqrt(points_of_a_tile(size)));
}

std::uint64_t stored_point(const RunSize& size) {
  return (size.precision == Precision::kSingle ? 16 : sizeof(StoredPoint)) +
         (size.has_normals ? sizeof(StoredNormal) : 0);
}

std::uint64_t sampled_points(const RunSize& size, const Job& job) {
  return std::min(size.points, static_cast<std::uint64_t>(job.config.results.sample_points));
}

// A point enters if its key is among the smallest so far.
std::uint64_t sample_keys(const RunSize& size, const Job& job) {
  const double sample = static_cast<double>(sampled_points(size, job));
  if (sample == 0) return 0;
  return static_cast<std::uint64_t>(sample * (1 + std::log(static_cast<double>(size.points) / sample))) *
         sizeof(ScanSample::Candidate);
}

std::uint64_t result_bytes() {
  return sizeof(StoredResult) + criteria().size() * sizeof(float);
}

}  // namespace

RunSize size_from_headers(const PointSource& scan, const Job& job) {
  constexpr std::uint64_t kMostRows = std::uint64_t{1} << 53;  // a broken header may have more
  RunSize size{.rows = std::min(scan.expected_points().value_or(0), kMostRows),
               .is_thinned = first_edge(job.config.scale) > 0,
               .has_levels = has_levels(job.config),
               .has_normals = scan.has_normals(),
               .reads_slowly = scan.reads_slowly()};
  if (!size.is_thinned) size.points = size.rows;
  size.tile_points = job.tile_points(size.points);
  return size;
}

std::uint64_t kept_bytes(const RunSize& size) {
  return size.reads_slowly ? size.rows * (size.has_normals ? 6 : 3) * sizeof(double) : 0;
}

DiskNeeds disk_needs(const RunSize& size, const Job& job) {
  const std::uint64_t spills = job.memory.spills;
  const ResultsConfig& wanted = job.config.results;
  const std::uint64_t store = size.points * stored_point(size);

  const std::uint64_t all = size.is_thinned ? size.rows * stored_point(size) : 0;  // before they are thinned
  const std::uint64_t represented =
      size.is_thinned && wanted.points ? beyond(size.rows * sizeof(Represented), spills / 8) : 0;
  const std::uint64_t sample = sampled_points(size, job) * sizeof(StoredSample);
  const std::uint64_t sorted_sample = beyond(sample_keys(size, job), spills / 8) + beyond(sample, spills / 8);
  const std::uint64_t results = wanted.points ? beyond(size.rows * result_bytes(), spills / 8) : 0;
  const std::uint64_t voxels =
      wanted.voxels ? size.points * sizeof(ProbabilityVoxel) : 0;  // at most one each
  const std::uint64_t voxel_work =
      wanted.voxels ? size.points * sizeof(float) +
                          sorted_on_disk(size.points * (sizeof(ProbabilityVoxel) + 8), job.memory.global / 3)
                    : 0;
  const std::uint64_t edges = size.points * sizeof(OrientationEdge);
  const std::uint64_t orientation = job.config.normals.orient
                                        ? size.points * sizeof(StoredNormal) + beyond(edges, spills / 16) +
                                              sorted_on_disk(edges, job.memory.global / 3)
                                        : 0;
  const std::uint64_t exchanged =
      border_bytes(size, kBeltBytes) + beyond(border_bytes(size, kListBytes), spills);

  const std::uint64_t above =
      size.has_levels
          ? static_cast<std::uint64_t>(kLevelAbove *
                                       static_cast<double>(exchanged + 2 * size.points * stored_point(size)))
          : 0;

  // The workspace also has the stores of levels above, and the outputs.
  const std::uint64_t kept =
      job.config.run.workspace.empty()
          ? 0
          : size.points * (kKeptBytes + stored_point(size) + (wanted.points ? result_bytes() : 0) +
                           (wanted.voxels ? sizeof(float) : 0) +
                           (job.config.normals.orient ? sizeof(StoredNormal) + sizeof(OrientationEdge) : 0));

  DiskNeeds needs;
  const std::uint64_t input = std::max(kept_bytes(size) + (all > 0 ? all : store), all + store + represented);
  needs.last = sample + results + voxels + represented +
               (size.is_thinned && wanted.points ? beyond(size.rows * kSpreadResult, spills / 4) : 0);
  needs.most = std::max({input,
                         store + exchanged + sorted_sample + sample + results + voxels + voxel_work +
                             orientation + represented + above,
                         needs.last}) +
               kept;
  needs.last += kept;
  return needs;
}

std::uint64_t memory_needs(const RunSize& size, const Job& job) {
  const ResultsConfig& wanted = job.config.results;
  const bool orients = job.config.normals.orient;
  const std::uint64_t spills = job.memory.spills;
  const double tile = points_of_a_tile(size);
  const auto tile_points = static_cast<std::uint64_t>(tile);
  const std::uint64_t tiles = tile_points > 0 ? size.points / tile_points : 0;
  const std::uint64_t fit = job.memory.tiles / job.tile_bytes(tile_points);
  const auto at_work =
      static_cast<double>(std::clamp<std::uint64_t>(std::min(fit, tiles), 1, job.arena.threads()));
  const double of_point = kPointAtWork + kCandidateAtWork * size.candidates + (orients ? kOrientedAtWork : 0);

  std::uint64_t lists =
      std::min(border_bytes(size, kListBytes), spills / 2) + std::min(sample_keys(size, job), spills / 8);
  if (orients) lists += std::min(size.points * sizeof(OrientationEdge), spills / 16);
  if (wanted.points) {
    lists += std::min(size.rows * result_bytes(), spills / 8);
    if (size.is_thinned) lists += std::min(size.rows * sizeof(Represented), spills / 8);
  }
  const auto evaluation = static_cast<std::uint64_t>(at_work * tile * of_point) + lists;
  return std::min(kProgram + evaluation, job.memory.limit);
}

}  // namespace lacuna
