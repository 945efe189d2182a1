// SPDX-License-Identifier: Apache-2.0
// State of GDAL for a thread or the whole program, held for as long as one file is written.
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <Eigen/Core>

class GDALDataset;
class OGRCoordinateTransformation;
class OGRFeature;
class OGRSpatialReference;

namespace lacuna::io {

// The date in the head of a GeoPackage: the same in every run.
inline constexpr const char* kSameTime = "1970-01-01T00:00:00.000Z";

// Closes a file when it is done with.
struct CloseDataset {
  void operator()(GDALDataset* dataset) const;
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

// Makes an empty file of a driver's format; null where GDAL fails.
Dataset create_dataset(const char* driver, const std::string& place);
// Sets a field; to null if the value is not finite.
void set_field(OGRFeature& feature, int field, double value);

// Reads a coordinate reference system, with x to the east, from a code or well-known text. It uses the
// database of PROJ alone, no network and no file that the text names. False where GDAL does not understand
// it.
bool read_exact_crs(const std::string& text, OGRSpatialReference& crs);
// Works likewise, but leaves out the vertical part of a code that GDAL does not understand.
bool read_crs(const std::string& text, OGRSpatialReference& crs);
// Reads the system of a file that is written. False, and none, where GDAL does not understand it.
bool read_crs_of_file(const std::string& text, OGRSpatialReference& crs);

// Converts positions of a system to longitude and latitude of WGS 84. z becomes metres, as RFC 7946 demands,
// above what it was above. Geocentric positions get the height above the ellipsoid.
struct DegreesConversion {
  std::unique_ptr<OGRCoordinateTransformation> plan;  // null where GDAL has no way
  double metres_of_z = 1;
};
// Takes the vertical part off `crs`.
DegreesConversion conversion_to_degrees(OGRSpatialReference& crs);
// False where the position has no longitude and latitude.
bool convert_to_degrees(const DegreesConversion& conversion, Eigen::Vector3d& position);

// A setting of GDAL, for this thread alone.
class GdalSetting {
 public:
  GdalSetting(const char* key, const char* value);
  ~GdalSetting();
  GdalSetting(const GdalSetting&) = delete;
  GdalSetting& operator=(const GdalSetting&) = delete;

 private:
  const char* key_;
};

// Makes equal GeoPackages of equal runs. They are synced in the end, once.
struct GeoPackageSettings {
  GdalSetting time{"OGR_CURRENT_DATE", kSameTime}, no_sync{"OGR_SQLITE_SYNCHRONOUS", "OFF"};
};

// Begins work with GDAL: registers the drivers of the formats that are read and written. Keeps the first
// failure that GDAL reports in this thread, as one short line, instead of printing it.
class GdalFailures {
 public:
  GdalFailures();
  ~GdalFailures();
  GdalFailures(const GdalFailures&) = delete;
  GdalFailures& operator=(const GdalFailures&) = delete;

  const std::string& first() const { return first_; }
  void forget() { first_.clear(); }
  // Throws `Error` about the file `name` that is written, unless all is well. A failure that GDAL reports
  // without an error in its answer is one, too.
  void require(bool is_well, const std::filesystem::path& name) const;

 private:
  std::string first_;
};

// Takes the text that GDAL writes to "/vsistdout/". GDAL does not check whether the text arrives, so this
// class does.
class GdalTextSink {
 public:
  using Take = std::function<void(std::string_view text)>;  // may throw

  explicit GdalTextSink(const Take& take);  // which must live as long
  ~GdalTextSink();
  GdalTextSink(const GdalTextSink&) = delete;
  GdalTextSink& operator=(const GdalTextSink&) = delete;

  // Throws the exception that `take` has thrown.
  void check() const;

 private:
  static std::size_t write(const void* data, std::size_t size, std::size_t count, FILE* stream);

  const Take& take_;
  std::exception_ptr failure_;
};

}  // namespace lacuna::io
