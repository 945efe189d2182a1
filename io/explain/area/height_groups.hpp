// SPDX-License-Identifier: Apache-2.0
// Heights of points that lie apart from those of the ground, as of no-data values and clouds.
#pragma once

#include <cstdint>
#include <vector>

namespace lacuna::io {

// A run of heights. The next ones above and below are further away than a gap.
struct HeightGroup {
  double low, high;
  std::uint64_t points;
};

// Divides heights at gaps without any height. A group is of the ground if it has a twentieth of the points or
// more, and more than one value. If none is so, it is the largest group. All other groups lie apart: rasters
// state one value for "no data", and returns of clouds, birds or mirrors are few. So steep ground, trees,
// towers and bridges belong to the ground, as long as their heights leave no such gap.
//
// The groups do not depend on the order of the heights. Memory: 24 bytes for each group, and 16,384 of them;
// heights beyond that lie apart.
class HeightGroups {
 public:
  explicit HeightGroups(double gap) : gap_(gap) {}

  void add(double height);

  // Both ascend. The groups of the ground are empty without a height.
  struct Parts {
    std::vector<HeightGroup> ground, apart;
  };
  Parts parts() const;

 private:
  double gap_;
  std::vector<HeightGroup> groups_;  // ascending
  std::size_t last_ = 0;             // the group of the last height
  std::uint64_t others_ = 0;         // heights beyond
};

// Whether a height is of one of the groups, or nearer to it than the gap.
bool is_of(const std::vector<HeightGroup>& groups, double height, double gap);

}  // namespace lacuna::io
