// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/gdal_session.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

namespace lacuna::io {

void CloseDataset::operator()(GDALDataset* dataset) const {
  GDALClose(dataset);
}

Dataset create_dataset(const char* driver, const std::string& place) {
  GDALDriver* const found = GetGDALDriverManager()->GetDriverByName(driver);
  return Dataset(found ? found->Create(place.c_str(), 0, 0, 0, GDT_Unknown, nullptr) : nullptr);
}

void set_field(OGRFeature& feature, int field, double value) {
  std::isfinite(value) ? feature.SetField(field, value) : feature.SetFieldNull(field);
}

bool read_exact_crs(const std::string& text, OGRSpatialReference& crs) {
  const char* const within_text[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  const bool is_read = crs.SetFromUserInput(text.c_str(), within_text) == OGRERR_NONE;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return is_read;
}

bool read_crs(const std::string& text, OGRSpatialReference& crs) {
  if (read_exact_crs(text, crs)) return true;
  const std::size_t plus = text.find('+');
  return plus != text.npos && read_exact_crs(text.substr(0, plus), crs);
}

bool read_crs_of_file(const std::string& text, OGRSpatialReference& crs) {
  const GdalFailures failures;
  if (text.empty() || read_crs(text, crs)) return true;
  crs.Clear();
  return false;
}

DegreesConversion conversion_to_degrees(OGRSpatialReference& crs) {
  OGRSpatialReference target;
  const bool is_geocentric = crs.IsGeocentric() != 0;
  constexpr int kFlat = 4326, kSolid = 4979;  // WGS 84, flat or with the height
  if (target.importFromEPSG(is_geocentric ? kSolid : kFlat) != OGRERR_NONE) return {};
  target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  DegreesConversion conversion;
  if (crs.IsProjected() != 0)
    conversion.metres_of_z = crs.GetTargetLinearUnits(crs.IsCompound() != 0 ? "VERT_CS" : nullptr);
  if (!is_geocentric) crs.StripVertical();
  conversion.plan.reset(OGRCreateCoordinateTransformation(&crs, &target));
  return conversion;
}

bool convert_to_degrees(const DegreesConversion& conversion, Eigen::Vector3d& position) {
  double &x = position.x(), &y = position.y(), &z = position.z();
  if (!conversion.plan->Transform(1, &x, &y, &z)) return false;
  z *= conversion.metres_of_z;
  return std::abs(x) <= 180 && std::abs(y) <= 90;
}

GdalSetting::GdalSetting(const char* key, const char* value) : key_(key) {
  CPLSetThreadLocalConfigOption(key, value);
}

GdalSetting::~GdalSetting() {
  CPLSetThreadLocalConfigOption(key_, nullptr);
}

namespace {

// Registers them once.
void register_drivers() {
  static const bool done = [] {
    const GdalSetting no_file_of_the_user("GDAL_CONFIG_FILE", "");
    RegisterOGRGeoPackage();
    RegisterOGRGeoJSON();
    GDALRegister_GTiff();
    RegisterOGRShape();
    RegisterOGRMEM();
    OSRSetPROJEnableNetwork(FALSE);
    return true;
  }();
  static_cast<void>(done);
}

// SQLite repeats the whole statement that failed, and its reason comes last.
std::string in_one_line(std::string text) {
  constexpr std::size_t kBegin = 40, kEnd = 100;
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= kBegin + kEnd) return text;
  const std::size_t failed = text.rfind(") failed: ");
  const std::size_t end = std::max(failed == text.npos ? 0 : failed, text.size() - kEnd);
  return text.substr(0, kBegin) + "..." + text.substr(end);
}

}  // namespace

GdalFailures::GdalFailures() {
  register_drivers();
  CPLPushErrorHandlerEx(
      [](CPLErr level, CPLErrorNum, const char* text) {
        auto& first = *static_cast<std::string*>(CPLGetErrorHandlerUserData());
        if (level >= CE_Failure && first.empty()) first = in_one_line(text);
      },
      &first_);
}

GdalFailures::~GdalFailures() {
  CPLPopErrorHandler();
}

void GdalFailures::require(bool is_well, const std::filesystem::path& name) const {
  if (is_well && first_.empty()) return;
  throw Error(name.string() + ": cannot be written: GDAL: " + (first_.empty() ? "no reason given" : first_));
}

GdalTextSink::GdalTextSink(const Take& take) : take_(take) {
  VSIStdoutSetRedirection(&GdalTextSink::write, reinterpret_cast<FILE*>(this));
}

GdalTextSink::~GdalTextSink() {
  VSIStdoutSetRedirection(&std::fwrite, stdout);
}

void GdalTextSink::check() const {
  if (failure_) std::rethrow_exception(failure_);
}

std::size_t GdalTextSink::write(const void* data, std::size_t size, std::size_t count, FILE* stream) {
  auto& sink = *reinterpret_cast<GdalTextSink*>(stream);
  try {
    if (!sink.failure_) sink.take_({static_cast<const char*>(data), size * count});
  } catch (...) {  // passes no frame of GDAL's
    sink.failure_ = std::current_exception();
  }
  return sink.failure_ ? 0 : count;
}

}  // namespace lacuna::io
