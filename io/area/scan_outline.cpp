// SPDX-License-Identifier: Apache-2.0
#include "io/area/scan_outline.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

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

template <class Visit>
void for_each_polygon(const OGRGeometry& geometry, const Visit& visit) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPolygon) {
    if (!geometry.IsEmpty()) visit(*geometry.toPolygon());
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* const part : *geometry.toGeometryCollection()) for_each_polygon(*part, visit);
  }
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

// How wide a bay at the border is at most that is a part of the polygon: a tenth of the polygon's width,
// which is four areas of its convex hull over the perimeter.
double narrow_bay(const OGRPolygon& polygon) {
  constexpr double kOfWidth = 0.1;
  const Geometry hull = made(polygon.ConvexHull());
  const Geometry border = made(hull->Boundary());
  const double perimeter = OGR_G_Length(OGRGeometry::ToHandle(border.get()));
  return kOfWidth * 4 * OGR_G_Area(OGRGeometry::ToHandle(hull.get())) / perimeter;
}

// Whether a polygon leaves out a bay. Its corners on the convex hull divide its border: each part lies
// between the ends of a bay's mouth.
bool leaves_bay(const OGRPolygon& polygon, double narrow, double void_size) {
  constexpr double kOfMouth = 0.2;
  const Geometry hull = made(polygon.ConvexHull());
  const OGRLinearRing& ring = *polygon.getExteriorRing();
  std::set<std::pair<double, double>> corners;
  for (const OGRPoint& corner : *hull->toPolygon()->getExteriorRing())
    corners.emplace(corner.getX(), corner.getY());
  const auto is_on_hull = [&](int i) { return corners.contains({ring.getX(i), ring.getY(i)}); };
  const int count = ring.getNumPoints() - 1;  // the last point is the first one again
  int first = 0;
  while (first < count && !is_on_hull(first)) ++first;
  OGRLinearRing bay;
  for (int i = first; i <= first + count; ++i) {
    const int at = i % count;
    bay.addPoint(ring.getX(at), ring.getY(at));
    if (!is_on_hull(at)) continue;
    if (bay.getNumPoints() > 2) {
      const double mouth = std::hypot(bay.getX(0) - ring.getX(at), bay.getY(0) - ring.getY(at));
      const double circle = std::max(void_size, std::min(narrow, kOfMouth * mouth));
      OGRPolygon outline;
      bay.closeRings();
      outline.addRing(&bay);
      if (!grown(*made(outline.Buffer(0)), -circle / 2)->IsEmpty()) return true;
    }
    bay.empty();
    bay.addPoint(ring.getX(at), ring.getY(at));
  }
  return false;
}

}  // namespace

extern "C" void lacuna_outline_scan(OutlineTask& task) {
  constexpr double kStep = 0.75, kFine = 0.25;  // of outlines along cells, and of arcs
  OGRMultiPolygon parts;
  polygonise(task.covered, [&](std::uint8_t, const OGRPolygon& part) {
    for_each_polygon(*made(part.SimplifyPreserveTopology(kStep)),
                     [&](const OGRPolygon& polygon) { parts.addGeometry(&polygon); });
  });
  for_each_polygon(*grown(*without_holes(parts), -task.reach), [&](const OGRPolygon& part) {
    if (part.get_Area() < 4 * task.reach * task.reach) return;
    const double narrow = narrow_bay(part);
    const Geometry closed = grown(*without_holes(*grown(part, narrow / 2)), -narrow / 2);
    for_each_polygon(*made(closed->SimplifyPreserveTopology(kFine)), [&](const OGRPolygon& polygon) {
      task.has_bay = task.has_bay || leaves_bay(polygon, narrow, task.void_size);
      task.polygons.push_back(outline_of(polygon));
    });
  });
}

}  // namespace lacuna::io
