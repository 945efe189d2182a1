// SPDX-License-Identifier: Apache-2.0
#include "io/area/area_polygons.hpp"

#include "engine/run/error.hpp"
#include "io/crs/gdal_session.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

bool is_of_degrees(const OGREnvelope& box) {
  return box.MinX >= -360 && box.MaxX <= 360 && box.MinY >= -90 && box.MaxY <= 90;
}

// The polygons of one file.
class Reader {
 public:
  explicit Reader(AreaPolygons& polygons) : to_(polygons) {}

  void read() {
    const char* const drivers[] = {"GPKG", "GeoJSON", "ESRI Shapefile", nullptr};
    const Dataset dataset(GDALDataset::Open(to_.file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers));
    std::error_code error;
    if (!dataset && !std::filesystem::exists(to_.file, error) && !to_.file.starts_with("/vsi"))
      throw Error(to_.file + ": no such file");
    if (!dataset) fail("cannot be read as GeoPackage, GeoJSON or Shapefile");
    const std::string_view format = dataset->GetDriverName();
    for (OGRLayer* const layer : dataset->GetLayers()) read(*layer, format == "GeoJSON");
    if (to_.polygons.empty()) fail("has no polygon");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    const std::string& text = failures_.first();
    throw Error(to_.file + ": " + reason + (text.empty() ? "" : " (GDAL: " + text + ")"));
  }

  // Degrees that are none come from a file that states no system, mostly.
  [[noreturn]] void fail_at_degrees(const OGREnvelope& box, bool is_geojson) const {
    std::ostringstream text;
    text.precision(10);
    text << to_.file << ": its coordinates, such as " << box.MinX << " " << box.MinY
         << ", are read as degrees "
         << (is_geojson
                 ? "by RFC 7946, unless a member `crs` of the file names their system; a GeoPackage "
                   "states one, too, as with `ogr2ogr -a_srs EPSG:N OUT.gpkg IN.geojson`"
                 : "of " + to_.file_crs + ", and are far beyond; `ogr2ogr -a_srs EPSG:N OUT.gpkg IN` " +
                       "states their system");
    throw Error(text.str());
  }

  void read(OGRLayer& layer, bool is_geojson) {
    const auto conversion = conversion_of(layer);
    const bool from_degrees = conversion && layer.GetSpatialRef()->IsGeographic() != 0;
    layer.ResetReading();
    while (const OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
      OGRGeometry* const geometry = feature->GetGeometryRef();
      if (geometry == nullptr || geometry->getDimension() != 2) continue;
      OGREnvelope box;
      geometry->getEnvelope(&box);
      if (from_degrees && !is_of_degrees(box)) fail_at_degrees(box, is_geojson);
      if (conversion && geometry->transform(conversion.get()) != OGRERR_NONE)
        fail("cannot be converted to the coordinate reference system of the scan");
      // Curved polygons become polygons of straight edges.
      const std::unique_ptr<OGRGeometry> straight(geometry->getLinearGeometry());
      add(*straight);
    }
    if (!failures_.first().empty()) fail("cannot be read");
  }

  void add(const OGRGeometry& geometry) {
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPolygon) {
      PlanPolygon polygon;
      for (const OGRLinearRing* const ring : *geometry.toPolygon()) add_ring(*ring, polygon);
      if (!polygon.empty()) to_.polygons.push_back(std::move(polygon));
    } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
      for (const OGRGeometry* const part : *geometry.toGeometryCollection()) add(*part);
    }
  }

  void add_ring(const OGRLinearRing& ring, PlanPolygon& polygon) {
    Ring2 corners;
    for (const OGRPoint& corner : ring) corners.emplace_back(corner.getX(), corner.getY());
    if (!corners.empty() && corners.front() == corners.back()) corners.pop_back();
    for (const Eigen::Vector2d& corner : corners) {
      if (!corner.allFinite()) fail("has a corner that is not finite");
    }
    if (corners.size() >= 3) polygon.push_back(std::move(corners));
  }

  // Null where positions are as they are.
  std::unique_ptr<OGRCoordinateTransformation> conversion_of(OGRLayer& layer) {
    const OGRSpatialReference* const given = layer.GetSpatialRef();
    if (given == nullptr || given->IsLocal() != 0) return nullptr;
    to_.file_crs = given->GetName();
    OGRSpatialReference from = *given, to;
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    from.StripVertical();
    if (to_.crs.empty() || !read_crs(to_.crs, to)) {
      failures_.forget();
      return nullptr;
    }
    to.StripVertical();
    if (from.IsSame(&to) != 0) return nullptr;
    std::unique_ptr<OGRCoordinateTransformation> conversion(OGRCreateCoordinateTransformation(&from, &to));
    if (!conversion) fail("cannot be converted to the coordinate reference system of the scan");
    to_.is_converted = true;
    return conversion;
  }

  AreaPolygons& to_;
  GdalFailures failures_;
};

}  // namespace

extern "C" void lacuna_read_area_polygons(AreaPolygons& polygons) {
  register_gdal_drivers();
  Reader(polygons).read();
}

}  // namespace lacuna::io
