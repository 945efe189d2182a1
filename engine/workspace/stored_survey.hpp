// SPDX-License-Identifier: Apache-2.0
// A survey as a record of a sealed part, without its cells.
#pragma once

#include "engine/survey/survey.hpp"

#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

namespace lacuna {

struct StoredBox {
  double min[3], max[3];

  StoredBox() = default;
  explicit StoredBox(const Eigen::AlignedBox3d& box) {
    for (int axis = 0; axis < 3; ++axis) min[axis] = box.min()[axis], max[axis] = box.max()[axis];
  }
  Eigen::AlignedBox3d box() const { return {Eigen::Vector3d(min), Eigen::Vector3d(max)}; }
};

struct StoredSurvey {
  StoredBox bounds;
  double middle[3], grid_origin[3];
  std::int64_t grid_finest, grid_shift;
  std::uint64_t points, dropped, ids, is_single;

  StoredSurvey() = default;
  explicit StoredSurvey(const SurveyedScan& survey)
      : bounds(survey.bounds),
        grid_finest(survey.grid.finest),
        grid_shift(survey.grid.shift),
        points(survey.points),
        dropped(survey.dropped),
        ids(survey.ids),
        is_single(survey.is_single) {
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = survey.middle[axis];
      grid_origin[axis] = survey.grid.origin[static_cast<std::size_t>(axis)];
    }
  }
  SurveyedScan survey() const {
    return {.grid = {.finest = static_cast<int>(grid_finest),
                     .shift = static_cast<int>(grid_shift),
                     .origin = {grid_origin[0], grid_origin[1], grid_origin[2]}},
            .cells = {},
            .bounds = bounds.box(),
            .middle = Eigen::Vector3d(middle),
            .points = points,
            .dropped = dropped,
            .ids = ids,
            .is_single = is_single != 0};
  }
};

}  // namespace lacuna
