// SPDX-License-Identifier: Apache-2.0
// Whether the axes of a scan can be what they are taken for: z upwards, and the same for all files.
//
// Idea: things stand on level surfaces. So the lower end of a column of the scan is level. Its upper end is
// that of a tree, a wall or a roof. Below a ceiling it is the other way: the ceiling is level, and things
// hide the floor.
#pragma once

#include "engine/model/detection.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/Core>

namespace lacuna::io {

struct Upward {
  Eigen::Index axis = 2;
  bool is_down = false;                  // the axis points downwards
  bool is_known = false;                 // whether it does; else both directions look alike
  std::array<std::uint64_t, 3> level{};  // points that are level along x, y and z
};

// Returns the axis that seems to be vertical, where that is not z, or where z points downwards. Returns
// nothing where z may point upwards: most points are level along it, and not twice as many columns
// contradict. `normals`: one for each point, of any side. `area`: of the surface that the points sample. At
// most 100,000 points are used, evenly. Cost: three sorts of them.
std::optional<Upward> other_upward(std::span<const Eigen::Vector3d> points,
                                   std::span<const Eigen::Vector3f> normals, double area);

// Finds files in the axes of their own scanners, as where poses were forgotten. Returns the first two files
// of which each can have been measured from 0 0 0, and both together cannot. Each has one range in four of
// five directions. They share half of their directions. In three of ten of these, their ranges differ by a
// fifth. `ends`: the first id behind each file. The sample of at most eight files is compared, in 300 kB for
// each.
std::optional<std::pair<std::size_t, std::size_t>> own_frames(const Detection& detection,
                                                              std::span<const std::uint64_t> ends);

}  // namespace lacuna::io
