// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/voids_gis.hpp"

#include "io/read/crs/gdal_session.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
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
    Fields columns = {{"id", OFTInteger64}, {"kind", OFTString},  {"counts", OFTInteger},
                      {"area", OFTReal},    {"circle", OFTReal},  {"x", OFTReal},
                      {"y", OFTReal},       {"spacing", OFTReal}, {"excepted", OFTReal}};
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
      for (const double value :
           {each.area, each.circle, each.middle.x(), each.middle.y(), each.spacing, each.excepted})
        set_field(feature, field++, value);
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

}  // namespace lacuna::io
