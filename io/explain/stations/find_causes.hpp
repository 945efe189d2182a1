// SPDX-License-Identifier: Apache-2.0
// find_causes: why no station sampled the inside of a hole. next_stations: where to stand next.
//
// Idea: each ray says that nothing lies before its end. So in the directions from a station to the inside of
// a hole, ranges are shorter where something hides it. Where rays pass, they are longer, or there are none.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/station_views.hpp"
#include "io/read/options/options.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

struct InnerSample {
  Eigen::Vector3d position, normal;  // the normal of length 1, on either side
  double area;                       // that the place represents
};

// Returns at least 256 places, spread evenly over the triangles of least area
// (io/explain/lids/make_lid.hpp) between some 64 points of the loop. The sum of the places' areas
// is the area of the triangles. Returns none if the loop has no area. The first kMostIslands of the islands
// in it are left out, each by some 16 points. Cost: 0.3 ms, and reading the loop.
std::vector<InnerSample> inside_places(const Detection& detection, std::size_t loop);
// This overload takes the points of a loop.
std::vector<InnerSample> inside_places(std::span<const Eigen::Vector3d> loop);

// Below this cosine of the angle of incidence a surface counts as out of view: rays at less than 3 degrees.
inline constexpr double kLeastIncidence = 0.0523;

// Places inside of a hole stand for its area. A station finds at each place:
//   1. a point at the same range: the place does not count
//   2. a point that a filter has left out: filtered
//   3. a longer range than the place's: opening
//   4. no return: opening, or no return, see below
//   5. a shorter range: hidden; or nothing, as the place is outside of its field of view, beyond its farthest
//      point, or seen at less than kLeastIncidence: out of view
// The first finding of this list counts among all stations. In 5, the nearest station decides.
//
// A place without return is an opening where a twentieth of the hole has longer ranges. Else it is an opening
// in a wall or a ceiling, and no return in a floor: rays that go down end on something. But where a part of
// the floor is hidden, that counts as hidden, too: dark things hide as others do. So a dark panel in a wall
// counts as an opening; the scan says nothing else of it.
//
// Holes keep unknown causes where there are no stations, or all places have points. Stations of little
// certainty do not count. Cost: some 0.3 ms for each hole and station.
// `tolerance`: ranges that differ by less are the same; the angle between rays adds to it.
// `after_place` is called after each place.
// `path` belongs to a moving scanner, and is null without one. Each section of it counts as a station, in the
// directions in which the scanner sweeps.
LoopCause cause_of(std::span<const InnerSample> places, std::span<const StationView> views,
                   const PathView* path, double tolerance, const std::function<void()>& after_place = {});
double tolerance_of(const LoopMeasures& loop);  // two mean edges of it

// Sets the cause of each hole, the stations, and what is up by the sample, as floors are found by z. Throws
// `Error` where the scan is read, as `StationViews::complete` does.
void find_causes(StationViews& stations, const RunConfig& run, ExplainedDetection& detection);

// next_stations: chooses the next places of the scanner, which show most of the hidden area.
//
// Idea: from each place on the floor a part of the hidden area is visible, where no voxel with points is in
// between. The function chooses places one after the other, each with the most area that is not visible from
// the places before. They reach at least 63 % of the area of as many best places (1 - 1/e: Nemhauser, Wolsey,
// Fisher, Mathematical Programming 1978).

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
