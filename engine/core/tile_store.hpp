// The tile store: every distinct point of the scan on disk, in cell order, so that a tile is one read and
// the cells around it are a few.
#pragma once

#include "engine/core/file.hpp"
#include "engine/core/spill.hpp"
#include "engine/data/tiling.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// As it stands on disk.
struct StoredPoint {
  double x, y, z;
  PointId id;

  Eigen::Vector3d position() const { return {x, y, z}; }
};

struct StoredNormal {
  double x, y, z;
};

// A point at the coordinates of another of the same tile, which has a lower id and stands for it.
struct Duplicate {
  PointId id;
  LocalIndex of;
};

// Written tile by tile while bucketing, read only from then on. Reads may come from several threads.
class TileStore {
 public:
  TileStore(const std::filesystem::path& folder, Tiling tiling, bool with_normals,
            std::uint64_t duplicate_budget);

  const Tiling& tiling() const { return tiling_; }
  bool has_normals() const { return has_normals_; }

  std::vector<StoredPoint> points(TileIndex tile) const;
  std::vector<Eigen::Vector3d> normals(TileIndex tile) const;  // as given; empty where none are
  std::vector<Duplicate> duplicates(TileIndex tile) const;     // in ascending id
  std::vector<StoredPoint> cell(std::uint32_t cell) const;

  // Points of these cells, ascending and without repeats, with their rows.
  void read_cells(std::span<const std::uint32_t> cells, std::vector<StoredPoint>& points,
                  std::vector<Row>& rows) const;

  // Bucketing: distinct points of a tile in cell order, and how many each of its cells holds.
  void put(TileIndex tile, std::span<const StoredPoint> points, std::span<const StoredNormal> normals,
           std::span<const std::uint64_t> cell_points, std::span<const Duplicate> duplicates);
  // All tiles are put: counts are final.
  void seal();

 private:
  Tiling tiling_;
  bool has_normals_;
  Column<StoredPoint> points_;
  Column<StoredNormal> normals_;
  Spill<Duplicate> duplicates_;
};

}  // namespace lacuna
