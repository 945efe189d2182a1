#include "engine/thin/choose_resolution.hpp"

#include "engine/neighbours/stored_search.hpp"
#include "engine/thin/lattice.hpp"
#include "engine/thin/local_sampling.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kSampleSize = 1000;

struct SamplePoint {
  std::uint64_t hash;  // of its coordinates
  StoredPoint point;
  Row row;

  friend bool operator<(const SamplePoint& a, const SamplePoint& b) { return a.hash < b.hash; }
};

// Keeps the lowest of all that is added.
class LowestHashes {
 public:
  void add(const SamplePoint& point) {
    if (point.hash >= limit_) return;
    points_.push_back(point);
    if (points_.size() == 2 * kSampleSize) shrink();
  }
  void add(LowestHashes&& other) {
    for (const SamplePoint& point : other.points_) add(point);
  }
  std::vector<SamplePoint> take() {
    if (points_.size() > kSampleSize) shrink();
    std::sort(points_.begin(), points_.end());
    return std::move(points_);
  }

 private:
  void shrink() {
    std::nth_element(points_.begin(), points_.begin() + kSampleSize, points_.end());
    limit_ = points_[kSampleSize].hash;
    points_.resize(kSampleSize);
  }

  std::vector<SamplePoint> points_;
  std::uint64_t limit_ = ~std::uint64_t{0};
};

std::vector<SamplePoint> sample_of(const TileStore& store, Job& job, Phase& phase) {
  const Tiling& tiling = store.tiling();
  LowestHashes lowest;
  std::mutex mutex;
  job.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    const Tile& tile = tiling.tiles[t];
    LowestHashes of_tile;
    LocalIndex owned = 0;
    store.for_each_point(static_cast<TileIndex>(t), [&](const StoredPoint& p) {
      of_tile.add({hash_of(p.position()), p, tile.row(owned++)});
    });
    phase.advance(tile.points);
    const std::lock_guard lock(mutex);
    lowest.add(std::move(of_tile));
  });
  return lowest.take();
}

std::optional<LocalSampling> sampling_around(const SamplePoint& sample, StoredSearch& search) {
  std::vector<StoredNeighbour> neighbours = search.nearest(sample.point, sample.row, kSamplingNeighbours);
  std::sort(neighbours.begin(), neighbours.end());
  std::vector<Eigen::Vector3d> offsets;
  for (const StoredNeighbour& n : neighbours) offsets.push_back(n.point.position() - sample.point.position());
  return measure_sampling(offsets);
}

}  // namespace

double choose_resolution(const TileStore& store, Job& job) {
  Phase phase(job, "resolution", store.tiling().points());
  if (store.tiling().points() < kSampleSize) return 0;
  const std::vector<SamplePoint> points = sample_of(store, job, phase);
  std::vector<std::optional<LocalSampling>> around(points.size());
  constexpr std::size_t kTogether = 50;
  job.arena.for_each((points.size() + kTogether - 1) / kTogether, [&](std::size_t run) {
    StoredSearch search(store);
    const std::size_t last = std::min(points.size(), (run + 1) * kTogether);
    for (std::size_t i = run * kTogether; i < last; ++i) around[i] = sampling_around(points[i], search);
  });
  std::vector<LocalSampling> sample;
  for (const auto& sampling : around) {
    if (sampling) sample.push_back(*sampling);
  }
  return resolution_of(sample);
}

}  // namespace lacuna
