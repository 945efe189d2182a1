// SPDX-License-Identifier: Apache-2.0
#include "io/area/polygonise.hpp"

#include "engine/run/error.hpp"
#include "io/crs/gdal_session.hpp"

#include <vector>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

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

}  // namespace

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

}  // namespace lacuna::io
