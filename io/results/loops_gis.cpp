// SPDX-License-Identifier: Apache-2.0
#include "io/results/loops_gis.hpp"

#include "engine/run/error.hpp"
#include "io/crs/gdal_session.hpp"
#include "io/loops/loop_measures.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <cpl_string.h>
#include <gdal.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

std::vector<const char*> layer_options(GisFormat format) {
  if (format == GisFormat::kGeoPackage) return {"DESCRIPTION=loops of lacuna detect"};
  // With digits behind the point instead, GDAL takes zeros before the last one for a rounding error.
  return {"RFC7946=NO", "SIGNIFICANT_FIGURES=17"};
}

struct Layer {
  OGRLayer* layer;  // the dataset's
  bool is_of_polygons;
};

// Writes one file.
class LoopsWriter {
 public:
  explicit LoopsWriter(const GisTask& task) : task_(task) {}

  GisCrs write() {
    GisCrs result = set_crs();
    const bool is_geojson = task_.format == GisFormat::kGeoJson;
    if (result == GisCrs::kWritten && (is_geojson || crs_.IsGeocentric() != 0) && !convert())
      result = GisCrs::kNotConverted;
    create();
    for (std::size_t id = 0; id < task_.detection.loops.size(); ++id) {
      const ReportedLoop loop = task_.detection.read_loop(id);
      for (const Layer& layer : layers_) put(id, loop, layer);
    }
    if (has_transaction_) require(dataset_->CommitTransaction() == OGRERR_NONE);
    dataset_.reset();
    require(true);
    return result;
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
    for (const char* const option : layer_options(task_.format)) options.AddString(option);
    OGRLayer* const layer =
        dataset_->CreateLayer(name, crs_.IsEmpty() ? nullptr : &crs_,
                              is_of_polygons ? wkbPolygon25D : wkbLineString25D, options.List());
    require(layer != nullptr);
    layers_.push_back({layer, is_of_polygons});
    add_field("id", OFTInteger64);
    add_field("kind", OFTString);
    add_field("cause", OFTString);
    add_field("unit", OFTString);
    for (const LoopMeasure& measure : kLoopMeasures)
      add_field(std::string(measure.name), measure.is_count ? OFTInteger64 : OFTReal);
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
    for (const LoopMeasure& measure : kLoopMeasures) {
      const double value = measure.of(explained);
      if (measure.is_count && std::isfinite(value)) {
        feature.SetField(field++, static_cast<GIntBig>(value));
      } else {
        set_field(feature, field++, value);
      }
    }
    auto line = line_of(loop.points);
    require(line != nullptr);
    feature.SetGeometryDirectly(layer.is_of_polygons ? polygon_of(id, *line).release() : line.release());
    require(layer.layer->CreateFeature(&feature) == OGRERR_NONE);
  }

  // RFC 7946 wants the outline counter-clockwise and inner rings clockwise.
  std::unique_ptr<OGRGeometry> polygon_of(std::size_t id, const OGRLineString& line) {
    auto polygon = std::make_unique<OGRPolygon>();
    const auto add = [&](const OGRLineString& points, bool is_clockwise) {
      auto ring = std::make_unique<OGRLinearRing>();
      ring->addSubLineString(&points);
      if ((ring->isClockwise() != 0) != is_clockwise) ring->reverseWindingOrder();
      polygon->addRingDirectly(ring.release());
    };
    add(line, false);
    for (const InnerRing& inner : task_.detection.inner_rings_of(id)) {
      const auto ring = line_of(task_.detection.read_points(inner.loop));
      require(ring != nullptr);
      add(*ring, true);
    }
    return polygon;
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
  Dataset dataset_;
  std::vector<Layer> layers_;
};

}  // namespace

extern "C" GisCrs lacuna_write_loops_gis(const GisTask& task) {
  const GeoPackageSettings settings;
  if (task.format != GisFormat::kGeoJson) return LoopsWriter(task).write();
  const GdalTextSink sink(task.take);
  LoopsWriter writer(task);
  GisCrs result = GisCrs::kNone;
  try {
    result = writer.write();
  } catch (const Error&) {
    sink.check();  // GDAL's failure may be the sink's
    throw;
  }
  sink.check();
  return result;
}

}  // namespace lacuna::io
