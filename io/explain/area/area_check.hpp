// SPDX-License-Identifier: Apache-2.0
// Whether a scan covers an area: the voids within polygons, seen from above.
#pragma once

#include "io/explain/area/plan_raster.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// The name and the form of voids.json, which docs/area.md describes.
inline constexpr const char* kVoidsFile = "voids.json";
inline constexpr std::string_view kVoidsSchema = "voids 2";

inline constexpr std::string_view kShareColumn = "in_";  // before the name of a class

enum class VoidKind : std::uint8_t {
  kHole,     // points are all around it
  kOpen,     // it reaches the border of the area, or the edge of the scan
  kOutside,  // it lies outside of the convex hull of all points
};
inline constexpr std::array<std::string_view, 3> kVoidKinds = {"hole", "open", "outside"};
constexpr std::string_view name_of(VoidKind kind) {
  return kVoidKinds[static_cast<std::size_t>(kind)];
}

// The first two are yes. The second one is all that a scan's own outline can show.
enum class AreaAnswer : std::uint8_t { kCovered, kCoveredWithin, kVoids, kNotDecided };
inline constexpr std::array<std::string_view, 4> kAreaAnswers = {"covered", "covered within its own outline",
                                                                 "voids", "not decided"};
constexpr std::string_view name_of(AreaAnswer answer) {
  return kAreaAnswers[static_cast<std::size_t>(answer)];
}

// Why the points of a scan do not decide whether it covers an area.
enum class Undecided : std::uint8_t {
  kNoPoint,           // none is in the bounds of the area
  kNoFirstReturn,     // none was measured, though later returns or synthetic points are there
  kSyntheticAlone,    // the scan has no other points
  kOtherSystems,      // files of the scan have different ones, and the config states none
  kFewPoints,         // a square grid of their spacing leaves circles of the void size empty, too
  kHeightsApart,      // voids are there only if points whose heights lie apart cover nothing
  kCoarseConversion,  // the polygons may lie off by more than half of the void size
  kSeveralParts,      // the scan has several parts, or many that are too small for its outline
  kBay,               // the outline of the scan leaves out a bay that is wider than the void size
};
inline constexpr std::array<std::string_view, 9> kUndecided = {
    "no point",          "no first return", "synthetic points alone",
    "different systems", "few points",      "heights apart",
    "coarse conversion", "several parts",   "bay"};
constexpr std::string_view name_of(Undecided reason) {
  return kUndecided[static_cast<std::size_t>(reason)];
}

// Lengths are in units of the scan, places in its coordinates.
struct Void {
  VoidKind kind = VoidKind::kHole;
  double area = 0;
  double circle = 0;             // diameter of the largest circle that fits in
  Eigen::Vector2d middle{0, 0};  // of that circle
  double spacing = 0;            // of the points around it; NaN where there are none
  double excepted = 0;           // share that lies in exceptions, [0, 1]
  std::vector<double> shares;    // of it within each of AreaCheck::classes, [0, 1]
  bool counts = true;            // not covered by an exception
  PlanPolygon outline;           // along cells; the outer ring first
};

// The columns of a void in voids.csv and voids.gpkg, after id, kind and counts, and before its shares.
struct VoidColumn {
  const char* name;
  double (*of)(const Void& each);
};
inline constexpr std::array<VoidColumn, 6> kVoidColumns = {
    {{"area", [](const Void& each) { return each.area; }},
     {"circle", [](const Void& each) { return each.circle; }},
     {"x", [](const Void& each) { return each.middle.x(); }},
     {"y", [](const Void& each) { return each.middle.y(); }},
     {"spacing", [](const Void& each) { return each.spacing; }},
     {"excepted", [](const Void& each) { return each.excepted; }}}};

// A square of the table of an area.
struct AreaTile {
  Eigen::Vector2d corner{0, 0};  // south-west
  double area = 0;               // of the project, within the tile
  double voids_area = 0;         // of it, within voids that count or not
  std::uint64_t points = 0;
  std::size_t voids = 0;  // that count, whose largest circles have their middles here

  double covered() const { return 1 - voids_area / area; }  // share of its area
  // The part without voids counts. They are not finite where there is none.
  double density() const { return static_cast<double>(points) / (area - voids_area); }
  double spacing() const { return 1 / std::sqrt(density()); }
};

struct AreaPolygon {
  PlanPolygon outline;
  double area = 0;          // 0: less than a cell
  double missing_area = 0;  // as in AreaCheck
  double circle = 0;        // the largest of the voids that count and have their middles here; 0: none

  double covered() const { return 1 - missing_area / area; }  // share of its area
};

// Polygons of a map, such as buildings.
struct AreaClass {
  std::string name;       // of their file, without folder and ending
  double voids_area = 0;  // of the voids that count, within them
};

// A thing that figures rest on, such as "returns", and what holds of it.
struct BasisLine {
  std::string thing, what;
};

// What no check shows, whatever its answer is.
inline constexpr std::array<std::string_view, 5> kNotShown = {
    "gaps that are narrower than the void size, however long they are",
    "what lies below a roof, a bridge or trees: seen from above, any point covers its place",
    "whether a place was measured by two swaths", "how accurate points are, and of which surface they are",
    "why a void is there, unless a map of --classes has it"};

// A run of heights. The next ones above and below are further away than a gap.
struct HeightGroup {
  double low, high;
  std::uint64_t points;
};

struct AreaCheck {
  std::vector<AreaPolygon> polygons;  // of the project
  bool is_outline = false;            // they are the scan's own outline
  double outline_cell = 0;            // edge of the cells of that outline
  double left_out = 0;                // of its convex hull: the area beyond the outline
  double void_size = 0;               // diameter of the least void
  double area = 0;                    // of the project
  double voids_area = 0;              // of all voids
  double missing_area = 0;            // of the voids that count, without what lies in exceptions
  double spacing = 0;                 // of the points, where there are any; NaN without a point
  std::vector<Undecided> undecided;   // empty if the points decide
  std::vector<BasisLine> basis;       // of all figures
  // These are as in PlanOfPoints.
  std::uint64_t points = 0, later_returns = 0, synthetic = 0, repeated = 0, near = 0;
  std::set<double> swaths;
  ScanCounts counts;
  bool counts_once = true;
  std::vector<HeightGroup> apart;
  double height_gap = 0;    // between them and the others
  double area_off = 0;      // how far the polygons may lie off, as their conversion says
  std::vector<Void> voids;  // those that count first; then by area, the largest first
  std::vector<AreaClass> classes;
  double tile_edge = 0;         // 0: no table
  std::vector<AreaTile> tiles;  // with a part of the area; from south to north, then from west to east

  std::size_t counting() const {
    std::size_t count = 0;
    while (count < voids.size() && voids[count].counts) ++count;
    return count;
  }
  // Points at a larger spacing leave circles of the void size empty even in a square grid.
  static double most_spacing(double void_size) { return void_size / std::numbers::sqrt2; }
  AreaAnswer answer() const { return answer(undecided.empty(), counting() > 0); }
  AreaAnswer answer_of(const AreaPolygon& polygon) const {
    return answer(undecided.empty() && polygon.area > 0, polygon.missing_area > 0);
  }
  bool is_covered() const { return undecided.empty() && counting() == 0; }

 private:
  AreaAnswer answer(bool is_decided, bool has_voids) const {
    return !is_decided  ? AreaAnswer::kNotDecided
           : has_voids  ? AreaAnswer::kVoids
           : is_outline ? AreaAnswer::kCoveredWithin
                        : AreaAnswer::kCovered;
  }
};

}  // namespace lacuna::io
