#include "engine/levels/stored_scan.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace lacuna {
namespace {

class StoredScan final : public PointSource {
 public:
  explicit StoredScan(const TileStore& store) : store_(store) {}

  void rewind() override { tile_ = 0; }
  bool next(PointBatch& batch) override {
    batch = {};
    const std::size_t tiles = store_.tiling().tiles.size();
    while (tile_ < tiles && batch.size() < kTogether) add(static_cast<TileIndex>(tile_++), batch);
    return batch.size() > 0;
  }
  std::optional<std::uint64_t> expected_points() const override { return store_.tiling().points(); }
  bool has_normals() const override { return store_.has_normals(); }

 private:
  static constexpr std::size_t kTogether = 1 << 16;  // points of a batch, but for its last tile

  void add(TileIndex tile, PointBatch& batch) {
    for (const StoredPoint& p : store_.points(tile)) {
      batch.ids.push_back(p.id);
      batch.positions.push_back(p.position());
    }
    if (!store_.has_normals()) return;
    const std::vector<Eigen::Vector3d> normals = store_.normals(tile);
    batch.normals.insert(batch.normals.end(), normals.begin(), normals.end());
  }

  const TileStore& store_;
  std::size_t tile_ = 0;
};

}  // namespace

std::unique_ptr<PointSource> read_store(const TileStore& store) {
  return std::make_unique<StoredScan>(store);
}

}  // namespace lacuna
