// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/check_normals.hpp"

#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/store_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace lacuna {
namespace {

constexpr std::uint64_t kSample = 2000;

// Scattered, since ids along the lines of a scan have a rhythm.
std::uint64_t scattered(PointId id) {
  return (value(id) + 1) * 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
}

bool is_sampled(PointId id, std::uint64_t points) {
  return points <= kSample || scattered(id) < std::numeric_limits<std::uint64_t>::max() / points * kSample;
}

// The sampled points of a tile come first, then the neighbours of each.
struct Sample {
  TilePoints points;
  Neighbourhoods neighbourhoods;
  std::vector<Eigen::Vector3d> normals;  // as given, of the sampled points
};

Sample sample_of(const TileStore& store, TileIndex index, std::size_t k) {
  const Tile& tile = store.tiling().tiles[index];
  const std::vector<Eigen::Vector3d> given = store.normals(index);
  const std::uint64_t points = store.tiling().points();
  std::vector<ScanPoint> sampled;
  std::vector<Row> rows;
  Sample sample;
  LocalIndex at = 0;
  store.for_each_point(index, [&](const ScanPoint& point) {
    const LocalIndex local = at++;
    if (!is_sampled(point.id, points) || !given[local].allFinite()) return;
    sampled.push_back(point);
    rows.push_back(tile.row(local));
    sample.normals.push_back(given[local]);
    sample.points.positions.push_back(point.position());
  });
  sample.points.owned = static_cast<LocalIndex>(sampled.size());

  StoreSearch search(store);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    std::vector<StoreNeighbour> nearest = search.nearest(sampled[i], rows[i], k);
    std::sort(nearest.begin(), nearest.end());
    for (const StoreNeighbour& neighbour : nearest) {
      sample.neighbourhoods.indices.push_back(static_cast<LocalIndex>(sample.points.positions.size()));
      sample.points.positions.push_back(neighbour.position());
    }
    sample.neighbourhoods.offsets.push_back(static_cast<std::uint32_t>(sample.neighbourhoods.indices.size()));
  }
  return sample;
}

// Only where the neighbourhood resembles a surface is the estimated normal worth more than the given one.
GivenNormals compare(const Sample& sample, const Config& config) {
  constexpr float kLeastSurface = 0.5F;
  constexpr double kCosine45 = std::numbers::sqrt2 / 2;
  GivenNormals normals;
  if (sample.normals.empty()) return normals;
  const std::vector<Evaluation> estimated =
      evaluate(sample.points, sample.neighbourhoods, {}, config.normals, config.criteria);
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    const double cosine = std::abs(estimated[i].normal.dot(sample.normals[i].stableNormalized()));
    if (std::isnan(cosine) || cosine == 0 || estimated[i].surface_share < kLeastSurface) continue;
    ++normals.checked;
    normals.off += cosine < kCosine45 ? 1 : 0;
  }
  return normals;
}

}  // namespace

GivenNormals check_normals(const TileStore& store, const Config& config, const TaskArena& arena) {
  std::vector<GivenNormals> of_tiles(store.tiling().tiles.size());
  arena.for_each(of_tiles.size(), [&](std::size_t t) {
    const auto k = static_cast<std::size_t>(config.neighbourhood.k);
    of_tiles[t] = compare(sample_of(store, static_cast<TileIndex>(t), k), config);
  });
  GivenNormals all;
  for (const GivenNormals& normals : of_tiles) {
    all.checked += normals.checked;
    all.off += normals.off;
  }
  return all;
}

}  // namespace lacuna
