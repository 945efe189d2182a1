// SPDX-License-Identifier: Apache-2.0
#include "io/area/trace_voids.hpp"

#include "engine/run/error.hpp"
#include "io/crs/gdal_session.hpp"

#include <exception>
#include <memory>
#include <string>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <geos_c.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {
namespace {

// GDAL reads the rows of a task from this band. They do not go through GDAL's cache of blocks, whose size is
// the process's.
class RowsBand : public GDALRasterBand {
 public:
  RowsBand(GDALDataset& dataset, const TraceTask& task) : task_(task), values_(task.columns) {
    poDS = &dataset;
    nBand = 1;
    eDataType = GDT_Byte;
    nRasterXSize = nBlockXSize = static_cast<int>(task.columns);
    nRasterYSize = static_cast<int>(task.rows);
    nBlockYSize = 1;
  }

  CPLErr IReadBlock(int, int, void*) override { return CE_Failure; }
  CPLErr IRasterIO(GDALRWFlag, int, int row, int columns, int rows, void* to, int, int, GDALDataType type,
                   GSpacing step, GSpacing, GDALRasterIOExtraArg*) override {
    if (columns != nRasterXSize || rows != 1) return CE_Failure;
    task_.row(static_cast<std::size_t>(row), values_);
    GDALCopyWords(values_.data(), GDT_Byte, 1, to, type, static_cast<int>(step), columns);
    return CE_None;
  }

 private:
  const TraceTask& task_;
  std::vector<std::uint8_t> values_;
};

class RowsDataset : public GDALDataset {
 public:
  explicit RowsDataset(const TraceTask& task) {
    nRasterXSize = static_cast<int>(task.columns);
    nRasterYSize = static_cast<int>(task.rows);
    SetBand(1, new RowsBand(*this, task));  // which the dataset owns
  }
};

PlanPolygon outline_of(const OGRPolygon& polygon) {
  PlanPolygon outline;
  for (const OGRLinearRing* const ring : polygon) {
    Ring2& corners = outline.emplace_back();
    for (int i = 0; i + 1 < ring->getNumPoints(); ++i) corners.emplace_back(ring->getX(i), ring->getY(i));
  }
  return outline;
}

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

}  // namespace

extern "C" void lacuna_trace_voids(TraceTask& task) {
  register_gdal_drivers();
  const GdalFailures failures;
  const auto require = [&](bool is_well) {
    if (!is_well) throw Error("outlines of voids: GDAL: " + failures.first());
  };
  RowsDataset rows(task);
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("Memory");
  require(driver != nullptr);
  const Dataset memory(driver->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  require(memory != nullptr);
  OGRLayer* const layer = memory->CreateLayer("voids", nullptr, wkbPolygon, nullptr);
  require(layer != nullptr);
  OGRFieldDefn value("value", OFTInteger);
  require(layer->CreateField(&value) == OGRERR_NONE);
  GDALRasterBand* const band = rows.GetRasterBand(1);  // its own mask, too: cells of 0 have no outline
  require(GDALPolygonize(band, band, layer, 0, nullptr, nullptr, nullptr) == CE_None);

  const LargestCircle circle;
  layer->ResetReading();
  while (const OGRFeatureUniquePtr feature{layer->GetNextFeature()}) {
    const OGRPolygon& polygon = *feature->GetGeometryRef()->toPolygon();
    TracedVoid& traced = task.voids.emplace_back(
        TracedVoid{static_cast<std::uint8_t>(feature->GetFieldAsInteger(0)), outline_of(polygon)});
    require(circle.find(polygon, traced));
  }
  require(failures.first().empty());
}

}  // namespace lacuna::io
