// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/coverage_tif.hpp"

#include "io/read/crs/gdal_session.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

namespace lacuna::io {
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
