// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/read/crs/gdal_session.hpp"
#include "io/write/loops/loop_measures.hpp"
#include "io/write/results/gis_results.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <cpl_string.h>
#include <gdal.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

using Geometry = std::unique_ptr<OGRGeometry>;

// Lets longitudes of a ring go on beyond 180 degrees, from one near `x`. False if it is around a pole.
bool unroll(OGRLinearRing& ring, double x) {
  for (int i = 0; i < ring.getNumPoints(); ++i) {
    x = ring.getX(i) + 360 * std::round((x - ring.getX(i)) / 360);
    ring.setPoint(i, x, ring.getY(i), ring.getZ(i));
  }
  return std::abs(x - ring.getX(0)) < 180;
}

// Cuts a shape in degrees into several where it crosses the antimeridian, a step of more than 180 degrees.
Geometry cut_at_antimeridian(const OGRGeometry& shape) {
  char wrap[] = "WRAPDATELINE=YES", each[] = "DATELINEOFFSET=180";
  char* options[] = {wrap, each, nullptr};
  return Geometry(OGRGeometryFactory::transformWithOptions(&shape, nullptr, options));
}

// Returns what a polygon covers, as polygons that cross neither themselves nor each other; null if nothing.
Geometry make_valid(Geometry polygon) {
  constexpr int kMostTries = 3;  // a mended polygon can need it again
  const GdalFailures reasons;    // of no interest
  const char* const options[] = {"METHOD=STRUCTURE", "KEEP_COLLAPSED=NO", nullptr};  // no lines or points
  for (int tries = 0; polygon && !polygon->IsEmpty() && tries <= kMostTries; ++tries) {
    if (polygon->IsValid()) return polygon;
    polygon.reset(polygon->MakeValid(options));
  }
  return nullptr;
}

// RFC 7946 wants outlines counter-clockwise and inner rings clockwise. GEOS leaves rings open in z.
void finish(OGRPolygon& polygon) {
  for (OGRLinearRing* const ring : polygon) {
    OGRPoint first;
    ring->getPoint(0, &first);
    ring->setPoint(ring->getNumPoints() - 1, &first);
    const bool is_inner = ring != polygon.getExteriorRing();
    if ((ring->isClockwise() != 0) != is_inner) ring->reverseWindingOrder();
  }
}

struct Layer {
  OGRLayer* layer;  // the dataset's
  bool is_of_polygons;
};

// Writes one file.
class LoopsWriter {
 public:
  explicit LoopsWriter(const GisTask& task) : task_(task) {}

  GisWritten write() {
    result_.crs = set_crs();
    const bool is_geojson = task_.format == GisFormat::kGeoJson;
    if (result_.crs == GisCrs::kWritten && (is_geojson || crs_.IsGeocentric() != 0) && !convert())
      result_.crs = GisCrs::kNotConverted;
    create();
    for (std::size_t id = 0; id < task_.detection.loops.size(); ++id) {
      const ReportedLoop loop = task_.detection.read_loop(id);
      for (const Layer& layer : layers_) put(id, loop, layer);
    }
    if (has_transaction_) require(dataset_->CommitTransaction() == OGRERR_NONE);
    dataset_.reset();
    require(true);
    return result_;
  }

 private:
  void require(bool is_well) const { failures_.require(is_well, task_.out.name); }

  GisCrs set_crs() {
    if (task_.out.crs.empty()) return GisCrs::kNone;
    has_crs_ = read_crs_of_file(task_.out.crs, crs_);
    return has_crs_ ? GisCrs::kWritten : GisCrs::kNotUnderstood;
  }

  // Converts to longitude and latitude, if GDAL has a way that holds for all loops. A geocentric GeoPackage
  // stays as it is without such a way.
  bool convert() {
    conversion_ = conversion_to_degrees(crs_);
    if (!converts_all()) conversion_.plan.reset();
    failures_.forget();
    if (task_.format == GisFormat::kGeoPackage) {
      if (conversion_.plan) crs_ = *conversion_.plan->GetTargetCS();
      return true;
    }
    has_crs_ = false;  // a GeoJSON names none
    crs_.Clear();
    return conversion_.plan != nullptr;
  }

  bool converts_all() {
    if (!conversion_.plan) return false;
    for (std::size_t id = 0; id < task_.detection.loops.size(); ++id) {
      if (!line_of(task_.detection.read_points(id))) return false;
      for (const InnerRing& ring : task_.detection.inner_rings_of(id)) {
        const bool is_reported = ring.loop < task_.detection.loops.size();
        if (!is_reported && !line_of(task_.detection.read_points(ring.loop))) return false;
      }
    }
    return true;
  }

  void create() {
    dataset_ = task_.format == GisFormat::kGeoPackage ? create_dataset("GPKG", task_.out.place.string())
                                                      : create_dataset("GeoJSON", "/vsistdout/");
    require(dataset_ != nullptr);
    // Without a crs the GeoPackage has the srs_id -1, and not 0, a geographic one.
    if (!has_crs_ && task_.format == GisFormat::kGeoPackage) crs_.SetLocalCS("Undefined Cartesian SRS");
    const bool has_two = task_.with_polygons && task_.format == GisFormat::kGeoPackage;
    create_layer(kGisLayer, task_.with_polygons && !has_two);
    if (has_two) create_layer(kGisAreas, true);
    if (dataset_->TestCapability(ODsCTransactions)) {
      has_transaction_ = true;
      require(dataset_->StartTransaction() == OGRERR_NONE);
    }
  }

  void create_layer(const char* name, bool is_of_polygons) {
    CPLStringList options;
    if (task_.format == GisFormat::kGeoPackage) {
      options.AddString("DESCRIPTION=loops of lacuna detect");
    } else {  // with digits behind the point instead, GDAL takes zeros before the last one for an error
      options.AddString("RFC7946=NO");
      options.AddString("SIGNIFICANT_FIGURES=17");
    }
    OGRwkbGeometryType type = is_of_polygons ? wkbPolygon25D : wkbLineString25D;
    if (has_several_parts(is_of_polygons)) type = OGR_GT_GetCollection(type);
    OGRLayer* const layer =
        dataset_->CreateLayer(name, crs_.IsEmpty() ? nullptr : &crs_, type, options.List());
    require(layer != nullptr);
    layers_.push_back({layer, is_of_polygons});
    add_field("id", OFTInteger64);
    add_field("kind", OFTString);
    add_field("cause", OFTString);
    add_field("unit", OFTString);
    for (const LoopMeasure& measure : kTableMeasures)
      add_field(std::string(measure.name), measure.is_count ? OFTInteger64 : OFTReal);
  }

  // Whether a loop has several shapes in the layer: the type of a GeoPackage's layer holds for all.
  bool has_several_parts(bool is_of_polygons) const {
    if (task_.format == GisFormat::kGeoJson || !(is_of_polygons || conversion_.plan)) return false;
    for (std::size_t id = 0; id < task_.detection.loops.size(); ++id) {
      const Geometry shape = shape_of(id, task_.detection.read_points(id), is_of_polygons);
      if (shape && OGR_GT_IsSubClassOf(shape->getGeometryType(), wkbGeometryCollection)) return true;
    }
    return false;
  }

  void add_field(const std::string& name, OGRFieldType type) {
    OGRFieldDefn field(name.c_str(), type);
    if (type == OFTString) field.SetWidth(16);  // longer than any kind or unit
    require(layers_.back().layer->CreateField(&field) == OGRERR_NONE);
  }

  void put(std::size_t id, const ReportedLoop& loop, const Layer& layer) {
    const ExplainedLoop explained = task_.detection.loop(id);
    OGRFeature feature(layer.layer->GetLayerDefn());
    int field = 0;
    feature.SetField(field++, static_cast<GIntBig>(id));
    feature.SetField(field++, lacuna::name_of(loop.measures.kind));
    const std::string cause(explained.cause.name());
    cause.empty() ? feature.SetFieldNull(field++) : feature.SetField(field++, cause.c_str());
    feature.SetField(field++, task_.unit.c_str());
    for (const LoopMeasure& measure : kTableMeasures) {
      const double value = measure.of(explained);
      if (measure.is_count && std::isfinite(value)) {
        feature.SetField(field++, static_cast<GIntBig>(value));
      } else {
        set_field(feature, field++, value);
      }
    }
    Geometry shape = shape_of(id, loop.points, layer.is_of_polygons);
    result_.without_polygon += shape == nullptr ? 1 : 0;
    const OGRwkbGeometryType type = layer.layer->GetGeomType();
    if (shape && OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
      shape.reset(OGRGeometryFactory::forceTo(shape.release(), type));
    feature.SetGeometryDirectly(shape.release());
    require(layer.layer->CreateFeature(&feature) == OGRERR_NONE);
  }

  // Returns what a layer has of a loop; null for a polygon that covers nothing, or is around a pole.
  Geometry shape_of(std::size_t id, const Loop& loop, bool is_polygon) const {
    auto line = line_of(loop);
    require(line != nullptr);
    Geometry shape = is_polygon ? polygon_of(id, *line) : Geometry(std::move(line));
    if (shape && conversion_.plan) shape = cut_at_antimeridian(*shape);
    if (shape && is_polygon) {
      if (wkbFlatten(shape->getGeometryType()) == wkbPolygon)
        finish(*shape->toPolygon());
      else
        for (OGRPolygon* const part : *shape->toMultiPolygon()) finish(*part);
    }
    return shape;
  }

  Geometry polygon_of(std::size_t id, const OGRLineString& line) const {
    auto polygon = std::make_unique<OGRPolygon>();
    bool has_inside = true;
    const auto add = [&](const OGRLineString& points) {
      auto ring = std::make_unique<OGRLinearRing>();
      ring->addSubLineString(&points);
      if (conversion_.plan) has_inside = unroll(*ring, line.getX(0)) && has_inside;
      polygon->addRingDirectly(ring.release());
    };
    add(line);
    for (const InnerRing& inner : task_.detection.inner_rings_of(id)) {
      const auto ring = line_of(task_.detection.read_points(inner.loop));
      require(ring != nullptr);
      add(*ring);
    }
    return has_inside ? make_valid(std::move(polygon)) : nullptr;
  }

  // Returns a closed line; null if a point of it cannot be converted.
  std::unique_ptr<OGRLineString> line_of(const Loop& loop) const {
    auto line = std::make_unique<OGRLineString>();
    const auto count = static_cast<int>(loop.size());  // loops.ply allows no more
    line->setNumPoints(count + 1);
    for (int i = 0; i <= count; ++i) {
      Eigen::Vector3d at = loop[static_cast<std::size_t>(i % count)].position();
      if (conversion_.plan && !convert_to_degrees(conversion_, at)) return nullptr;
      line->setPoint(i, at.x(), at.y(), at.z());
    }
    return line;
  }

  const GisTask& task_;
  GdalFailures failures_;
  OGRSpatialReference crs_;
  DegreesConversion conversion_;  // of a GeoJSON
  bool has_crs_ = false, has_transaction_ = false;
  GisWritten result_;
  Dataset dataset_;
  std::vector<Layer> layers_;
};

}  // namespace

extern "C" GisWritten lacuna_write_loops_gis(const GisTask& task) {
  const GeoPackageSettings settings;
  if (task.format != GisFormat::kGeoJson) return LoopsWriter(task).write();
  const GdalTextSink sink(task.take);
  LoopsWriter writer(task);
  GisWritten result;
  try {
    result = writer.write();
  } catch (const Error&) {
    sink.check();  // GDAL's failure may be the sink's
    throw;
  }
  sink.check();
  return result;
}

namespace {

// Writes one file.
class VoidsWriter {
 public:
  VoidsWriter(const AreaCheck& check, const GisOutput& out) : check_(check), out_(out) {}

  bool write() {
    const bool is_understood = read_crs_of_file(out_.crs, crs_);
    // Without a crs the GeoPackage has the srs_id -1, and not 0, a geographic one.
    if (crs_.IsEmpty()) crs_.SetLocalCS("Undefined Cartesian SRS");
    dataset_ = create_dataset("GPKG", out_.place.string());
    require(dataset_ != nullptr);
    Fields columns = {{"id", OFTInteger64}, {"kind", OFTString}, {"counts", OFTInteger}};
    for (const VoidColumn& column : kVoidColumns) columns.emplace_back(column.name, OFTReal);
    for (const AreaClass& each : check_.classes)
      columns.emplace_back(std::string(kShareColumn) + each.name, OFTReal);
    write_voids(create_layer(kVoidsLayer, columns));
    write_polygons(create_layer(
        kAreaLayer, {{"answer", OFTString}, {"area", OFTReal}, {"covered", OFTReal}, {"circle", OFTReal}}));
    if (!check_.tiles.empty())
      write_tiles(create_layer(kTilesLayer, {{"area", OFTReal},
                                             {"covered", OFTReal},
                                             {"voids", OFTInteger64},
                                             {"points", OFTInteger64},
                                             {"density", OFTReal},
                                             {"spacing", OFTReal}}));
    write_styles();
    dataset_.reset();
    require(true);
    return is_understood;
  }

 private:
  using Fields = std::vector<std::pair<std::string, OGRFieldType>>;

  void require(bool is_well) const { failures_.require(is_well, out_.name); }

  OGRLayer& create_layer(const char* name, const Fields& fields) {
    CPLStringList options;
    options.AddString("DESCRIPTION=voids of an area");
    OGRLayer* const layer = dataset_->CreateLayer(name, &crs_, wkbPolygon, options.List());
    require(layer != nullptr);
    for (const auto& [field_name, type] : fields) {
      OGRFieldDefn field(field_name.c_str(), type);
      require(layer->CreateField(&field) == OGRERR_NONE);
    }
    return *layer;
  }

  // QGIS draws a layer by its row in this table. GDAL does not list the table as a layer of data.
  void write_styles() const {
    struct Style {
      const char *layer, *fill, *line;  // red, green, blue, opacity
    };
    CPLStringList options;
    options.AddString("ASPATIAL_VARIANT=NOT_REGISTERED");
    options.AddString("FID=id");
    OGRLayer* const table = dataset_->CreateLayer("layer_styles", nullptr, wkbNone, options.List());
    require(table != nullptr);
    for (const char* const name : {"f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column",
                                   "styleName", "styleQML", "styleSLD", "description", "owner"}) {
      OGRFieldDefn field(name, OFTString);
      require(table->CreateField(&field) == OGRERR_NONE);
    }
    OGRFieldDefn is_default("useAsDefault", OFTInteger), time("update_time", OFTDateTime);
    is_default.SetSubType(OFSTBoolean);
    require(table->CreateField(&is_default) == OGRERR_NONE && table->CreateField(&time) == OGRERR_NONE);
    for (const auto& [layer, fill, line] : {Style{kVoidsLayer, "210,68,15,140", "210,68,15,255"},
                                            Style{kAreaLayer, "255,255,255,0", "26,30,33,255"},
                                            Style{kTilesLayer, "27,95,180,40", "89,98,105,120"}}) {
      if (dataset_->GetLayerByName(layer) == nullptr) continue;
      OGRFeature feature(table->GetLayerDefn());
      for (const char* const empty : {"f_table_catalog", "f_table_schema", "styleSLD", "owner"})
        feature.SetField(empty, "");
      feature.SetField("f_table_name", layer);
      feature.SetField("f_geometry_column", "geom");
      feature.SetField("styleName", "lacuna");
      feature.SetField("description", "colours of lacuna");
      feature.SetField("useAsDefault", 1);
      feature.SetField("update_time", kSameTime);
      feature.SetField(
          "styleQML",
          ("<!DOCTYPE qgis><qgis version=\"3.22\" styleCategories=\"Symbology\"><renderer-v2 "
           "type=\"singleSymbol\"><symbols><symbol type=\"fill\" name=\"0\" alpha=\"1\"><layer "
           "class=\"SimpleFill\" enabled=\"1\"><prop k=\"style\" v=\"solid\"/><prop k=\"color\" v=\"" +
           std::string(fill) + "\"/><prop k=\"outline_color\" v=\"" + line +
           "\"/><prop k=\"outline_width\" v=\"0.3\"/></layer></symbol></symbols></renderer-v2></qgis>")
              .c_str());
      require(table->CreateFeature(&feature) == OGRERR_NONE);
    }
  }

  static std::unique_ptr<OGRPolygon> polygon_of(const PlanPolygon& outline) {
    auto polygon = std::make_unique<OGRPolygon>();
    for (const Ring2& corners : outline) {
      auto ring = std::make_unique<OGRLinearRing>();
      ring->setNumPoints(static_cast<int>(corners.size()), FALSE);
      for (std::size_t i = 0; i < corners.size(); ++i)
        ring->setPoint(static_cast<int>(i), corners[i].x(), corners[i].y());
      ring->closeRings();
      polygon->addRingDirectly(ring.release());
    }
    polygon->flattenTo2D();
    return polygon;
  }

  // Writes a feature for each element of a list. `fill` sets its fields, and returns its outline.
  template <class List, class Fill>
  void write_features(OGRLayer& layer, const List& list, const Fill& fill) const {
    require(layer.StartTransaction() == OGRERR_NONE);
    for (const auto& element : list) {
      OGRFeature feature(layer.GetLayerDefn());
      feature.SetGeometryDirectly(polygon_of(fill(feature, element)).release());
      require(layer.CreateFeature(&feature) == OGRERR_NONE);
    }
    require(layer.CommitTransaction() == OGRERR_NONE);
  }

  void write_voids(OGRLayer& layer) const {
    GIntBig id = 0;
    write_features(layer, check_.voids, [&](OGRFeature& feature, const Void& each) {
      feature.SetField(0, id++);
      feature.SetField(1, std::string(name_of(each.kind)).c_str());
      feature.SetField(2, each.counts ? 1 : 0);
      int field = 3;
      for (const VoidColumn& column : kVoidColumns) set_field(feature, field++, column.of(each));
      for (const double share : each.shares) set_field(feature, field++, share);
      return std::cref(each.outline);
    });
  }

  void write_polygons(OGRLayer& layer) const {
    write_features(layer, check_.polygons, [&](OGRFeature& feature, const AreaPolygon& polygon) {
      feature.SetField(0, std::string(name_of(check_.answer_of(polygon))).c_str());
      set_field(feature, 1, polygon.area);
      set_field(feature, 2, polygon.covered());
      set_field(feature, 3, polygon.circle);
      return std::cref(polygon.outline);
    });
  }

  void write_tiles(OGRLayer& layer) const {
    write_features(layer, check_.tiles, [&](OGRFeature& feature, const AreaTile& tile) {
      set_field(feature, 0, tile.area);
      set_field(feature, 1, tile.covered());
      feature.SetField(2, static_cast<GIntBig>(tile.voids));
      feature.SetField(3, static_cast<GIntBig>(tile.points));
      set_field(feature, 4, tile.density());
      set_field(feature, 5, tile.spacing());
      const double edge = check_.tile_edge, x = tile.corner.x(), y = tile.corner.y();
      return PlanPolygon{{{x, y}, {x + edge, y}, {x + edge, y + edge}, {x, y + edge}}};
    });
  }

  const AreaCheck& check_;
  const GisOutput& out_;
  GdalFailures failures_;
  OGRSpatialReference crs_;
  Dataset dataset_;
};

}  // namespace

extern "C" bool lacuna_write_voids_gis(const AreaCheck& check, const GisOutput& out) {
  const GeoPackageSettings settings;
  return VoidsWriter(check, out).write();
}

namespace {

std::vector<float> spacings(const CoverageGrid& grid) {
  std::vector<float> spacings(grid.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.points[i] > 0)
      spacings[i] = static_cast<float>(grid.edge / std::sqrt(static_cast<double>(grid.points[i])));
  }
  return spacings;
}

}  // namespace

extern "C" bool lacuna_write_coverage(const CoverageGrid& grid, const GisOutput& out) {
  const GdalFailures failures;
  const auto require = [&](bool is_well) { failures.require(is_well, out.name); };
  const auto columns = static_cast<int>(grid.columns), rows = static_cast<int>(grid.rows);
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  require(driver != nullptr);
  CPLStringList options;
  for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", "BIGTIFF=IF_SAFER"})
    options.AddString(option);
  Dataset dataset(driver->Create(out.place.c_str(), columns, rows, 3, GDT_Float32, options.List()));
  require(dataset != nullptr);
  dataset->SetMetadataItem("TIFFTAG_SOFTWARE", "Lacuna coverage");
  double to_map[6] = {grid.corner.x(), grid.edge, 0, grid.corner.y(), 0, -grid.edge};
  require(dataset->SetGeoTransform(to_map) == CE_None);
  OGRSpatialReference crs;
  const bool is_understood = read_crs_of_file(out.crs, crs);
  if (!crs.IsEmpty()) require(dataset->SetSpatialRef(&crs) == CE_None);
  std::vector<float> spacing = spacings(grid);
  const auto put = [&](int band, const char* name, const std::vector<float>& values) {
    GDALRasterBand* const to = dataset->GetRasterBand(band);
    to->SetDescription(name);
    require(to->RasterIO(GF_Write, 0, 0, columns, rows, const_cast<float*>(values.data()), columns, rows,
                         GDT_Float32, 0, 0) == CE_None);
  };
  require(dataset->GetRasterBand(2)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN()) == CE_None);
  put(1, "points", grid.points);
  put(2, "spacing", spacing);
  put(3, "holes", grid.holes);
  dataset.reset();
  require(true);
  return is_understood;
}

}  // namespace lacuna::io
