// SPDX-License-Identifier: Apache-2.0
// next_stations: chooses the next places of the scanner, which show most of the hidden area.
//
// Idea: from each place on the floor a part of the hidden area is visible, where no voxel with points is in
// between. The function chooses places one after the other, each with the most area that is not visible from
// the places before. They reach at least 63 % of the area of as many best places (1 - 1/e: Nemhauser, Wolsey,
// Fisher, Mathematical Programming 1978).
#pragma once

#include "io/explain/stations/find_causes.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

class Obstacles {
 public:
  // `voxel`: its edge, above 0. Memory: a few bytes for each voxel with points.
  Obstacles(std::span<const Eigen::Vector3d> points, double voxel);
  ~Obstacles();

  // Whether a voxel with points lies on the line from `eye` to `place`. The voxels around both ends do not
  // count: up to two voxels from the place, and one from the eye. Cost: the voxels on the line.
  bool block(const Eigen::Vector3d& eye, const Eigen::Vector3d& place) const;
  bool touch(const Eigen::AlignedBox3d& box) const;  // whether a voxel in the box has points

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
  Eigen::Vector3d origin_{0, 0, 0};  // near the points, which may be far from 0 0 0
  double voxel_;
};

// The file is in the folder of results. A program recognises an earlier one by how it begins.
inline constexpr const char* kNextStationsFile = "next_stations.geojson";
inline constexpr std::string_view kNextStationsMark =
    "{\n  \"type\": \"FeatureCollection\",\n  \"name\": \"lacuna_next_stations\"";

struct SightLimits {
  double range = 0;         // how far a scanner measures
  double least_cosine = 0;  // of the angle of incidence
};

struct NextStation {
  std::size_t index = 0;  // of the eye
  Eigen::Vector3d eye;
  double area = 0;  // that is visible from it, and from none before it
};

// Returns at most `most` of the eyes. It stops when the next eye would add less than a hundredth of all
// hidden area. Among equal eyes the first counts. Cost: a ray for each eye and hidden place, in the arena of
// the calling thread; greedy choice is linear in them for each station.
std::vector<NextStation> choose_stations(std::span<const InnerSample> hidden,
                                         std::span<const Eigen::Vector3d> eyes, const Obstacles& obstacles,
                                         const SightLimits& limits, std::size_t most);

// Below this cosine between its normal and the vertical, a point is on no floor.
inline constexpr float kLevelFloor = 0.95F;

// Above this share of an eye's height, the space over a floor must be free.
inline constexpr double kFreeFrom = 0.2;

struct FloorLimits {
  double height = 1.6;   // of an eye over the floor
  double grid = 0;       // distance of places; 0: half the height, and so far that there are at most 500
  double clearance = 0;  // free space around the axis of an eye
};

// Returns eyes over the scanned floor: level points that are the lowest near them, with free space above up
// to the eye. They are in ascending y, then x. `normals` has one for each point, of any side.
std::vector<Eigen::Vector3d> eyes_over_floor(std::span<const Eigen::Vector3d> points,
                                             std::span<const Eigen::Vector3f> normals,
                                             const Obstacles& obstacles, const FloorLimits& limits);

}  // namespace lacuna::io
