// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/read/crs/gdal_session.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <geos_c.h>
#include <ogr_api.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

// ---- polygons of a raster

// GDAL reads the rows of a raster from this band. They do not go through GDAL's cache of blocks, whose size
// is the process's.
class RowsBand : public GDALRasterBand {
 public:
  RowsBand(GDALDataset& dataset, const RasterRows& raster) : raster_(raster), values_(raster.columns) {
    poDS = &dataset;
    nBand = 1;
    eDataType = GDT_Byte;
    nRasterXSize = nBlockXSize = static_cast<int>(raster.columns);
    nRasterYSize = static_cast<int>(raster.rows);
    nBlockYSize = 1;
  }

  CPLErr IReadBlock(int, int, void*) override { return CE_Failure; }
  CPLErr IRasterIO(GDALRWFlag, int, int row, int columns, int rows, void* to, int, int, GDALDataType type,
                   GSpacing step, GSpacing, GDALRasterIOExtraArg*) override {
    if (columns != nRasterXSize || rows != 1) return CE_Failure;
    raster_.row(static_cast<std::size_t>(row), values_);
    GDALCopyWords(values_.data(), GDT_Byte, 1, to, type, static_cast<int>(step), columns);
    return CE_None;
  }

 private:
  const RasterRows& raster_;
  std::vector<std::uint8_t> values_;
};

class RowsDataset : public GDALDataset {
 public:
  explicit RowsDataset(const RasterRows& raster) {
    nRasterXSize = static_cast<int>(raster.columns);
    nRasterYSize = static_cast<int>(raster.rows);
    SetBand(1, new RowsBand(*this, raster));  // which the dataset owns
  }
};

// Calls visit(value, polygon) for each part: cells of one value that share edges. Outlines run along the
// cells.
void polygonise(const RasterRows& raster,
                const std::function<void(std::uint8_t value, const OGRPolygon& polygon)>& visit) {
  const GdalFailures failures;
  const auto require = [&](bool is_well) {
    if (!is_well) throw Error("outlines of voids: GDAL: " + failures.first());
  };
  RowsDataset rows(raster);
  const Dataset memory = create_dataset("Memory", "");
  require(memory != nullptr);
  OGRLayer* const layer = memory->CreateLayer("voids", nullptr, wkbPolygon, nullptr);
  require(layer != nullptr);
  OGRFieldDefn value("value", OFTInteger);
  require(layer->CreateField(&value) == OGRERR_NONE);
  GDALRasterBand* const band = rows.GetRasterBand(1);  // its own mask, too: cells of 0 have no outline
  require(GDALPolygonize(band, band, layer, 0, nullptr, nullptr, nullptr) == CE_None);
  layer->ResetReading();
  while (const OGRFeatureUniquePtr feature{layer->GetNextFeature()})
    visit(static_cast<std::uint8_t>(feature->GetFieldAsInteger(0)), *feature->GetGeometryRef()->toPolygon());
  require(failures.first().empty());
}

PlanPolygon outline_of(const OGRPolygon& polygon) {
  PlanPolygon outline;
  for (const OGRLinearRing* const ring : polygon) {
    Ring2& corners = outline.emplace_back();
    for (int i = 0; i + 1 < ring->getNumPoints(); ++i) corners.emplace_back(ring->getX(i), ring->getY(i));
  }
  return outline;
}

// ---- voids

// The largest circle in a polygon, from GEOS.
class LargestCircle {
 public:
  LargestCircle() : geos_(OGRGeometry::createGEOSContext()) {}
  ~LargestCircle() { OGRGeometry::freeGEOSContext(geos_); }
  LargestCircle(const LargestCircle&) = delete;
  LargestCircle& operator=(const LargestCircle&) = delete;

  // Sets its middle and radius, to within half a cell.
  bool find(const OGRPolygon& polygon, TracedVoid& of) const {
    constexpr double kTolerance = 0.5;
    const auto destroy = [this](GEOSGeometry* geometry) { GEOSGeom_destroy_r(geos_, geometry); };
    using Geometry = std::unique_ptr<GEOSGeometry, decltype(destroy)>;
    const Geometry converted(polygon.exportToGEOS(geos_), destroy);
    if (!converted) return false;
    const Geometry line(GEOSMaximumInscribedCircle_r(geos_, converted.get(), kTolerance), destroy);
    if (!line) return false;
    const GEOSCoordSequence* const ends = GEOSGeom_getCoordSeq_r(geos_, line.get());
    Eigen::Vector2d rim(0, 0);
    if (ends == nullptr || GEOSCoordSeq_getXY_r(geos_, ends, 0, &of.middle.x(), &of.middle.y()) == 0 ||
        GEOSCoordSeq_getXY_r(geos_, ends, 1, &rim.x(), &rim.y()) == 0)
      return false;
    of.radius = (rim - of.middle).norm();
    return true;
  }

 private:
  GEOSContextHandle_t geos_;
};

// ---- the outline of a scan

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

// Returns how wide a bay is at most that is a part of the polygon. It is a tenth of the polygon's width: four
// areas of its convex hull over the perimeter.
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

extern "C" void lacuna_trace_voids(TraceTask& task) {
  const LargestCircle circle;
  polygonise(task.raster, [&](std::uint8_t value, const OGRPolygon& polygon) {
    TracedVoid& traced = task.voids.emplace_back(TracedVoid{value, outline_of(polygon)});
    if (!circle.find(polygon, traced)) throw Error("outlines of voids: GEOS finds no largest circle");
  });
}

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
