// SPDX-License-Identifier: Apache-2.0
// Points: as a scan gives them, and on their way from the input to the tile store.
#pragma once

#include "engine/export.hpp"
#include "engine/model/ids.hpp"
#include "engine/model/task_share.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// A coordinate beyond this value is an `Error`, and so is a scan of a smaller extent than this one.
// Differences between points are of single precision in places, and would overflow or vanish.
inline constexpr double kFarthest = 1e30;
inline constexpr double kLeastExtent = 1e-30;
inline bool is_too_far(const Eigen::Vector3d& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() > kFarthest;
}

// A point of the scan as plain data, which may be written to disk as it is.
struct ScanPoint {
  double x, y, z;
  PointId id;

  static ScanPoint at(const Eigen::Vector3d& p, PointId id) { return {p.x(), p.y(), p.z(), id}; }
  Eigen::Vector3d position() const { return {x, y, z}; }
};

// Points of the input in ascending id. Non-finite points are included.
struct PointBatch {
  PointId first{};
  std::vector<PointId> ids;  // of each point; empty where point i has id `first + i`
  std::vector<Eigen::Vector3d> positions;
  // Normals as given. If the source has normals, there is one for each position, NaN where a file has none.
  // Else the vector is empty.
  std::vector<Eigen::Vector3d> normals;

  std::size_t size() const { return positions.size(); }
  PointId id(std::size_t i) const { return ids.empty() ? PointId{value(first) + i} : ids[i]; }
};

// The parts of a source, such as files: tasks share them, and a run that is kept knows them again.
struct SourceParts {
  // About how many points each part has. Empty where parts cannot be read apart.
  std::vector<std::uint64_t> points;
  // One line for each part, and for all else that points depend on. Lines are equal only where the points
  // are. Empty where a source cannot identify its parts. Then no part is kept.
  std::vector<std::string> identity;
  std::vector<std::string> names;  // open the same parts again, in whatever form the source's program reads
};

// One registered scan, in any unit of length. It is read in bounded batches, from the first point to the last
// and as often as wanted. Ids ascend. One thread at a time calls it, not always the same thread. Several
// batches are in memory at once. Throws `Error` naming file and place.
class LACUNA_API PointSource {
 public:
  virtual ~PointSource() = default;

  virtual void rewind() = 0;
  // Fills the batch with the next points. Returns false, and an empty batch, at the end.
  virtual bool next(PointBatch& batch) = 0;
  // Returns the number of points where headers have it, for progress and buffer sizes. Text files do not have
  // it.
  virtual std::optional<std::uint64_t> expected_points() const = 0;
  virtual bool has_normals() const = 0;
  // Returns whether a pass costs more than to write and read a file of plain numbers, as in compressed
  // formats.
  virtual bool reads_slowly() const { return false; }
  virtual SourceParts parts() const { return {}; }
  // Lets the next pass read these parts alone. Their first point gets the id `first`. Other passes read all.
  virtual void rewind_to(const IndexRange& /*parts*/, PointId /*first*/) { rewind(); }
  // Returns counts of the last pass, such as rows that filters left out. They are kept for runs that
  // do not read again. Those of parts add up to those of the source.
  virtual std::vector<std::uint64_t> pass_counts() const { return {}; }
  virtual void set_pass_counts(std::span<const std::uint64_t>) {}
  // Throws `Error` that says why a pass over all parts has found no finite point. For most sources it is no
  // error.
  virtual void refuse_empty() const {}
};

}  // namespace lacuna
