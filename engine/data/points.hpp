// Points on their way from the input to the tile store.
#pragma once

#include "engine/data/ids.hpp"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Consecutive points of the input, non-finite ones included. Point i has id `first + i`.
struct PointBatch {
  PointId first{};
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  // as given in the file; empty where it has none

  std::size_t size() const { return positions.size(); }
};

// One registered scan, read in bounded batches, as often as wanted. Throws `Error` naming file and place.
class PointSource {
 public:
  virtual ~PointSource() = default;

  virtual void rewind() = 0;
  // Fills the batch with the next points; false, and an empty batch, at the end.
  virtual bool next(PointBatch& batch) = 0;
  // Number of points where the headers tell, for progress and buffer sizes; text files do not.
  virtual std::optional<std::uint64_t> expected_points() const = 0;
  virtual bool has_normals() const = 0;
};

}  // namespace lacuna
