// SPDX-License-Identifier: Apache-2.0
// Why no scanner sampled the inside of a hole, and a detection with that.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/station.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

enum class Cause : std::uint8_t {
  kHidden,     // nearer points stand before it
  kOpening,    // the rays pass, as through a window or a door
  kOutOfView,  // of each scanner: its field of view, its range, or grazing rays
  kNoReturn,   // nothing came back, and nothing lies behind: dark, wet, water
  kFiltered,   // points were there, and a filter of this run left them out
};
inline constexpr std::array<std::string_view, 5> kCauseNames = {"hidden", "opening", "out_of_view",
                                                                "no_return", "filtered"};
inline constexpr std::size_t kCauses = kCauseNames.size();

struct LoopCause {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  // Shares of the hole's area, which sum to 1; NaN where no station is known.
  std::array<double, kCauses> shares = {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  // One of the points that hide it, in their middle, and the largest extent of all of them; NaN where
  // nothing does.
  Eigen::Vector3d hidden_by = Eigen::Vector3d::Constant(kUnknown);
  double hidden_by_extent = kUnknown;
  std::int32_t hidden_from = -1;  // number of the station that most of it is hidden from; -1: no station
  Eigen::Vector3d hidden_from_place = Eigen::Vector3d::Constant(kUnknown);  // of its scanner, at that time

  double share(Cause cause) const { return shares[static_cast<std::size_t>(cause)]; }
  // Returns the cause with the largest share, the first of equal ones; nothing where no station is known.
  std::optional<Cause> main() const {
    std::size_t largest = 0;
    for (std::size_t i = 1; i < kCauses; ++i)
      if (shares[i] > shares[largest]) largest = i;
    return shares[largest] > 0 ? std::optional(static_cast<Cause>(largest)) : std::nullopt;
  }
  // Returns the name of that cause; empty where it is not known.
  std::string_view name() const {
    const std::optional<Cause> cause = main();
    return cause ? kCauseNames[static_cast<std::size_t>(*cause)] : std::string_view();
  }
};

// Where a scanner stood, and what it saw.
struct StationSummary {
  std::string name;
  std::string subject;             // whose points are of it, such as "number 1 of a.ply"; empty: all
  Eigen::Vector3d place{0, 0, 0};  // of a path: halfway
  double path = 0;                 // length of the path of a moving scanner; 0 for a fixed one
  Trajectory::LeftOut left_out;    // rows of that path
  std::uint64_t points = 0;
  std::uint64_t untimed = 0;       // further points, which have no time of the path
  double coarse_step = 0;          // of its times, if too wide for the path; infinite: there is one time
  double certainty = 0;            // share of points that fit it: seen from there, and at its times
  double spread = 0;               // RaySpread::angle
  double lowest = 0, highest = 0;  // sines of the elevations of its points
  double turn = 0;                 // share of a whole turn with points
  double step = 0;                 // mean angle between rays, radians
  double farthest = 0;             // range
  double one_range = 0;            // that many rays have, to a thousandth, as without a return; 0: none

  // Below it, the station did not measure its points, and takes no part in causes.
  static constexpr double kLeastCertain = 0.98;
  bool counts() const { return certainty >= kLeastCertain; }
};

// The points of a scan that no station has measured, where stations are known.
struct PointsOfNone {
  std::uint64_t points = 0;
  std::string subject;  // of the first of them, such as "number 0 of a.ply"
};

// Whether the axes of a scan can be what they are taken for: z upwards, and the same for all files.
//
// Idea: things stand on level surfaces. So the lower end of a column of the scan is level. Its upper end is
// of a tree, a wall or a roof. Below a ceiling it is the other way: the ceiling is level, and things
// hide the floor.

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

// A loop with the cause of its hole.
struct ExplainedLoop : LoopMeasures {
  LoopCause cause;
};

// What a run on files has found.
struct ExplainedDetection : Detection {
  ExplainedDetection(Detection found, ScanCounts counts)
      : Detection(std::move(found)), counts(std::move(counts)) {}

  ScanCounts counts;                          // of the pass over the scan
  std::vector<StationSummary> stations = {};  // that are known
  PointsOfNone points_of_none = {};
  std::optional<Upward> upward = {};   // where stations are known, and z does not seem to point upwards
  std::vector<LoopCause> causes = {};  // of each loop; empty where no station is known

  // Returns the part of Summary::hole_area that is not missing surface: of holes whose main cause is an
  // opening. Returns nothing where no cause is known.
  std::optional<double> opening_area() const {
    std::optional<double> area;
    for (std::size_t i = 0; i < causes.size(); ++i)
      if (const auto cause = causes[i].main())
        area = area.value_or(0) + (cause == Cause::kOpening ? loops[i].own_area : 0);
    return area;
  }
  ExplainedLoop loop(std::size_t i) const { return {loops[i], causes.empty() ? LoopCause() : causes[i]}; }
};

}  // namespace lacuna::io
