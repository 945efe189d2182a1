// SPDX-License-Identifier: Apache-2.0
// find_causes: why no station sampled the inside of a hole.
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
#include <span>
#include <vector>

#include <Eigen/Core>

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

}  // namespace lacuna::io
