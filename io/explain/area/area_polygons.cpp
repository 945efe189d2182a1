// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/area_polygons.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/gdal_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

bool is_of_degrees(const Eigen::Vector2d& place) {
  return std::abs(place.x()) <= 360 && std::abs(place.y()) <= 90;
}

constexpr std::uint64_t kBytesOfCorner = 2 * sizeof(double);

// Returns a text as SQL has it.
std::string in_sql(std::string_view text) {
  std::string all = "'";
  for (const char c : text) all.append(c == '\'' ? 2 : 1, c);
  return all + "'";
}

// The polygons of one file.
class Reader {
 public:
  explicit Reader(HeldPolygons& polygons) : to_(polygons) {}

  void read() {
    if (to_.polygons.empty()) return read_layers();
    OGRSpatialReference crs;
    if (to_.file_crs.empty()) return;
    if (!read_exact_crs(to_.file_crs, crs)) fail("its member crs is no known system");
    convert(0, &crs, true);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    const std::string& text = failures_.first();
    throw Error(to_.file + ": " + reason + (text.empty() ? "" : " (GDAL: " + text + ")"));
  }

  void read_layers() {
    const char* const drivers[] = {"GPKG", "ESRI Shapefile", nullptr};
    const Dataset dataset(GDALDataset::Open(to_.file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers));
    if (!dataset) fail("cannot be read as GeoPackage, GeoJSON or Shapefile");
    const bool is_geopackage = std::string_view(dataset->GetDriverName()) == "GPKG";
    for (OGRLayer* const layer : dataset->GetLayers()) {
      if (is_geopackage && !has_geometries(*dataset, *layer)) continue;
      read(*layer);
    }
  }

  // Whether a layer is a table of geometries. To find the columns of a view, GDAL runs it, so the name comes
  // first.
  bool has_geometries(GDALDataset& dataset, OGRLayer& layer) const {
    const std::string name = layer.GetName(), text = in_sql(name);
    if (first_value(dataset, "SELECT COUNT(*) FROM gpkg_geometry_columns WHERE lower(table_name) = lower(" +
                                 text + ")") == 0)
      return false;
    if (first_value(dataset,
                    "SELECT COUNT(*) FROM sqlite_master WHERE type = 'table' AND "
                    "sql NOT LIKE 'CREATE VIRTUAL%' AND lower(name) = lower(" +
                        text + ")") == 0)
      fail("layer " + name + " is no table, but a view, which may have no end; `ogr2ogr OUT.gpkg IN.gpkg " +
           name + "` makes a table of it");
    return true;
  }

  // Returns the number that a query gives; 0 for none.
  double first_value(GDALDataset& dataset, const std::string& query) const {
    const auto release = [&](OGRLayer* layer) { dataset.ReleaseResultSet(layer); };
    const std::unique_ptr<OGRLayer, decltype(release)> rows(
        dataset.ExecuteSQL(query.c_str(), nullptr, nullptr), release);
    if (!rows) fail("cannot be read");
    const OGRFeatureUniquePtr row{rows->GetNextFeature()};
    return row && row->GetFieldCount() > 0 ? row->GetFieldAsDouble(0) : 0;
  }

  void read(OGRLayer& layer) {
    const std::size_t first = to_.polygons.size();
    // A value of another column may be of any length.
    std::vector<const char*> columns;
    const OGRFeatureDefn& definition = *layer.GetLayerDefn();
    for (int i = 0; i < definition.GetFieldCount(); ++i)
      columns.push_back(definition.GetFieldDefn(i)->GetNameRef());
    columns.push_back(nullptr);
    layer.SetIgnoredFields(columns.data());
    layer.ResetReading();
    while (const OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
      const OGRGeometry* const geometry = feature->GetGeometryRef();
      if (geometry == nullptr || geometry->getDimension() != 2) continue;
      const OGRGeometryUniquePtr straight(geometry->hasCurveGeometry() ? geometry->getLinearGeometry()
                                                                       : nullptr);
      const OGRGeometry& shape = straight ? *straight : *geometry;
      check_corners(to_, shape.WkbSize() / kBytesOfCorner);
      add(shape);
    }
    if (!failures_.first().empty()) fail("cannot be read");
    convert(first, layer.GetSpatialRef(), false);
  }

  void add(const OGRGeometry& geometry) {
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPolygon) {
      PlanPolygon polygon;
      for (const OGRLinearRing* const ring : *geometry.toPolygon()) add_ring(ring_of(*ring), polygon);
      if (!polygon.empty()) take_polygon(std::move(polygon), to_);
    } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
      for (const OGRGeometry* const part : *geometry.toGeometryCollection()) add(*part);
    }
  }

  Ring2 ring_of(const OGRLinearRing& ring) const {
    Ring2 corners;
    corners.reserve(static_cast<std::size_t>(ring.getNumPoints()));
    for (int i = 0; i < ring.getNumPoints(); ++i) corners.emplace_back(ring.getX(i), ring.getY(i));
    return corners;
  }

  // Converts the polygons from the first one on.
  void convert(std::size_t first, const OGRSpatialReference* given, bool is_geojson) {
    const auto conversion = conversion_from(given);
    if (!conversion) return;
    const bool from_degrees = given->IsGeographic() != 0;
    const std::span polygons = std::span(to_.polygons).subspan(first);
    if (!polygons.empty()) note_accuracy(*conversion, polygons.front().front().front());
    for (PlanPolygon& polygon : polygons) {
      std::uint64_t corners = 0;
      for (Ring2& ring : polygon) {
        if (from_degrees) check_degrees(ring, is_geojson);
        to_.corners -= ring.size();
        ring = converted(ring, *conversion, from_degrees);
        to_.corners += ring.size();
        corners += ring.size();
      }
      to_.most_in_one = std::max(to_.most_in_one, corners);
    }
  }

  void check_degrees(const Ring2& ring, bool is_geojson) const {
    for (const Eigen::Vector2d& corner : ring)
      if (!is_of_degrees(corner)) fail_at_degrees(corner, is_geojson);
  }

  Eigen::Vector2d converted(Eigen::Vector2d place, OGRCoordinateTransformation& conversion) const {
    if (conversion.Transform(1, &place.x(), &place.y()) == FALSE || !place.allFinite())
      fail("cannot be converted to the coordinate reference system of the scan");
    return place;
  }

  // Converts a ring, whose edges are cut into equal parts. A part bends by a square of its length, so the
  // bend of the edge at its quarters says how many parts are straight enough.
  Ring2 converted(const Ring2& ring, OGRCoordinateTransformation& conversion, bool from_degrees) const {
    constexpr double kWholeTurn = 360, kMostParts = 1e6;
    Ring2 result;
    Eigen::Vector2d from = converted(ring.front(), conversion);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
      const Eigen::Vector2d to = converted(b, conversion);
      Eigen::Vector2d edge = b - a;
      if (from_degrees) edge.x() = std::remainder(edge.x(), kWholeTurn);  // across the antimeridian
      double bend = 0;
      for (const double at : {0.25, 0.5, 0.75})
        bend = std::max(bend, (converted(a + at * edge, conversion) - (from + at * (to - from))).norm());
      const double parts = std::clamp(std::ceil(std::sqrt(bend / to_.bend)), 1.0, kMostParts);
      check_corners(to_, result.size() + static_cast<std::uint64_t>(parts) + ring.size() - i - 1);
      result.push_back(from);
      for (double part = 1; part < parts; ++part)
        result.push_back(converted(a + part / parts * edge, conversion));
      from = to;
    }
    return result;
  }

  void note_accuracy(OGRCoordinateTransformation& conversion, const Eigen::Vector2d& place) {
    to_.accuracy =
        accuracy_of(*conversion.GetSourceCS(), *conversion.GetTargetCS(), {place.x(), place.y(), 0});
  }

  // Degrees that are none come from a file that states no system, mostly.
  [[noreturn]] void fail_at_degrees(const Eigen::Vector2d& place, bool is_geojson) const {
    std::ostringstream text;
    text.precision(10);
    text << to_.file << ": its coordinates, such as " << place.x() << " " << place.y()
         << ", are read as degrees "
         << (is_geojson
                 ? "by RFC 7946, unless a member `crs` of the file names their system; a GeoPackage "
                   "states one, too, as with `ogr2ogr -a_srs EPSG:N OUT.gpkg IN.geojson`"
                 : "of " + to_.file_crs + ", and are far beyond; `ogr2ogr -a_srs EPSG:N OUT.gpkg IN` " +
                       "states their system");
    throw Error(text.str());
  }

  // Null where positions are as they are.
  std::unique_ptr<OGRCoordinateTransformation> conversion_from(const OGRSpatialReference* given) {
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

  HeldPolygons& to_;
  GdalFailures failures_;
};

}  // namespace

extern "C" void lacuna_read_area_polygons(HeldPolygons& polygons) {
  Reader(polygons).read();
}

}  // namespace lacuna::io
