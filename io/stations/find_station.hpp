// SPDX-License-Identifier: Apache-2.0
// find_stations: finds the place of the scanner of each sweep from its points alone.
//
// Idea: where a scanner's rays pass an edge, the next point lies far behind it or before it. Its ray is one
// small step of angle away. So the lines through both points of all such jumps pass near the scanner. From
// there, the step across a jump is as wide as the steps before and after it. From other places it is much
// wider.
#pragma once

#include "io/scan/scan_pass.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Four points that follow each other. The middle two are ten times farther apart than the others.
using Jump = std::array<Eigen::Vector3d, 4>;

// Collects the jumps of a sweep, in the order in which it was measured. At most so many jumps represent all.
class Jumps {
 public:
  static constexpr std::size_t kMost = 8192;

  void add(const Eigen::Vector3d& position);  // not finite: nothing came back, and the line is interrupted
  std::span<const Jump> jumps() const { return kept_; }

 private:
  Jump last_;
  std::size_t known_ = 0;  // of the last four points
  std::vector<Jump> kept_;
  std::uint64_t seen_ = 0, stride_ = 1;
};

struct FoundStation {
  // Below this share, the points are not of one sweep in its order. Measured: docs/stations.md.
  static constexpr double kLeastShare = 0.15;

  Eigen::Vector3d place;
  double share;  // the share of jumps with the angle of the steps around them
};

// Returns nothing for fewer than 100 jumps. Cost: linear in their number. The same jumps give the same
// result: places to try are drawn with a fixed seed.
std::optional<FoundStation> find_station(std::span<const Jump> jumps);

// The points of a file, or its points with one number in the column `scan` or `point_source_id`.
struct Sweep {
  std::size_t file;
  std::optional<std::uint32_t> source;
  Jumps jumps;
};

// Reads the scan. Returns sweeps in the order of files and numbers, at most kMostSweeps. Throws `Error`.
inline constexpr std::size_t kMostSweeps = 1000;
std::vector<Sweep> read_sweeps(const ScanFiles& scan);

}  // namespace lacuna::io
