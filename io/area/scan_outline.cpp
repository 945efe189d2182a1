// SPDX-License-Identifier: Apache-2.0
#include "io/area/scan_outline.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <memory>

#include <ogr_api.h>
#include <ogr_geometry.h>

namespace lacuna::io {
namespace {

using Geometry = std::unique_ptr<OGRGeometry>;

constexpr int kQuarter = 8;  // edges of a quarter of a circle

Geometry made(OGRGeometry* geometry) {
  if (geometry == nullptr) throw Error("outline of the scan: GEOS fails");
  return Geometry(geometry);
}

Geometry grown(const OGRGeometry& geometry, double distance) {
  return made(geometry.Buffer(distance, kQuarter));
}

// Grows by steps that double, since a circle grown by a circle is one. Few outlines are left for the wide
// steps, which took minutes where points are sparse.
Geometry grown_far(const OGRGeometry& geometry, double distance, double step) {
  Geometry result = made(geometry.clone());
  for (double done = 0; done < distance; step *= 2) {
    step = std::min(step, distance - done);
    result = grown(*result, step);
    done += step;
  }
  return result;
}

template <class Visit>
void for_each_polygon(const OGRGeometry& geometry, const Visit& visit) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPolygon) {
    if (!geometry.IsEmpty()) visit(*geometry.toPolygon());
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* const part : *geometry.toGeometryCollection()) for_each_polygon(*part, visit);
  }
}

double area_of(const OGRGeometry& geometry) {
  double area = 0;
  for_each_polygon(geometry, [&](const OGRPolygon& polygon) { area += polygon.get_Area(); });
  return area;
}

Geometry without_holes(const OGRGeometry& geometry) {
  OGRMultiPolygon filled;
  for_each_polygon(geometry, [&](const OGRPolygon& polygon) {
    OGRPolygon outer;
    outer.addRingDirectly(polygon.getExteriorRing()->clone());
    filled.addGeometry(&outer);
  });
  return filled.IsEmpty() ? made(filled.clone()) : made(filled.UnionCascaded());
}

// Whether a part of the closing is a corner of the scan, and no bay: its mouth is wide for its area. The
// fillet of a right angle has a twelfth of the square of its mouth. A channel has about a half of it if it is
// as long as wide.
bool is_corner(const OGRPolygon& part, const OGRGeometry& near_covered, double least_area) {
  constexpr double kShallow = 0.25;
  const double area = part.get_Area();
  if (area < least_area) return true;
  const Geometry border = made(part.Boundary());
  const Geometry mouth = made(border->Difference(&near_covered));
  const double length = OGR_G_Length(OGRGeometry::ToHandle(mouth.get()));
  return area < kShallow * length * length;
}

}  // namespace

extern "C" void lacuna_outline_scan(OutlineTask& task) {
  constexpr double kStep = 0.75, kOff = 1;  // of outlines along cells
  const double least_area = 4 * task.reach * task.reach;
  OGRMultiPolygon parts;
  polygonise(task.covered, [&](std::uint8_t, const OGRPolygon& part) {
    for_each_polygon(*made(part.SimplifyPreserveTopology(kStep)),
                     [&](const OGRPolygon& polygon) { parts.addGeometry(&polygon); });
  });
  const Geometry covered = without_holes(parts);
  const Geometry closed =
      without_holes(*grown(*grown_far(*covered, task.bay / 2, task.reach), -task.bay / 2));
  const Geometry near_covered = grown(*covered, kOff);
  OGRMultiPolygon corners;
  for_each_polygon(*made(closed->Difference(covered.get())), [&](const OGRPolygon& part) {
    if (is_corner(part, *near_covered, least_area)) corners.addGeometry(&part);
  });
  const Geometry outline = made(closed->Difference(&corners));
  if (2 * area_of(*outline) < area_of(*closed)) return;
  for_each_polygon(*grown(*outline, -task.reach), [&](const OGRPolygon& polygon) {
    if (polygon.get_Area() >= least_area) task.polygons.push_back(outline_of(polygon));
  });
}

}  // namespace lacuna::io
