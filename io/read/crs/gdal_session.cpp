// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/gdal_session.hpp"

#include "engine/run/error.hpp"
#include "io/read/crs/crs_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <string_view>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>
#include <proj.h>

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

namespace {

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const {
    proj_operation_factory_context_destroy(factory);
  }
};
template <class T>
using Owned = std::unique_ptr<T, Destroy>;

// The ways from a system to another around a place, the best first.
class Ways {
 public:
  Ways(const OGRSpatialReference& from, const OGRSpatialReference& to, const Eigen::Vector3d& degrees)
      : context_(proj_context_create()), degrees_(degrees) {
    proj_log_level(context_.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context_.get(), 0);
    from_ = system_of(from);
    to_ = system_of(to);
  }

  // Returns the best one; null without any. `may_lack_grids`: one whose grids are not on this machine, too.
  Owned<PJ> best(bool may_lack_grids) const {
    if (!from_ || !to_) return nullptr;
    constexpr double kAround = 1e-3;
    const Owned<PJ_OPERATION_FACTORY_CONTEXT> factory(
        proj_create_operation_factory_context(context_.get(), nullptr));
    PJ_OPERATION_FACTORY_CONTEXT* const in = factory.get();
    const double x = degrees_.x(), y = degrees_.y();
    proj_operation_factory_context_set_area_of_interest(context_.get(), in, x - kAround, y - kAround,
                                                        x + kAround, y + kAround);
    proj_operation_factory_context_set_spatial_criterion(context_.get(), in,
                                                         PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
    proj_operation_factory_context_set_grid_availability_use(
        context_.get(), in,
        may_lack_grids ? PROJ_GRID_AVAILABILITY_IGNORED
                       : PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
    const Owned<PJ_OBJ_LIST> ways(proj_create_operations(context_.get(), from_.get(), to_.get(), in));
    return Owned<PJ>(
        ways && proj_list_get_count(ways.get()) > 0 ? proj_list_get(context_.get(), ways.get(), 0) : nullptr);
  }

  // In metres; 0: exact, or not stated.
  double accuracy_of(const PJ& way) const {
    if (proj_coordoperation_has_ballpark_transformation(context_.get(), &way) != 0)
      return std::numeric_limits<double>::infinity();
    return std::max(proj_coordoperation_get_accuracy(context_.get(), &way), 0.0);
  }

  // Whether it is more than projections and units.
  bool moves_datum(const PJ& way) const {
    if (proj_coordoperation_get_grid_used_count(context_.get(), &way) > 0) return true;
    const char* const steps = proj_as_proj_string(context_.get(), &way, PJ_PROJ_5, nullptr);
    if (steps == nullptr) return true;
    for (const char* const step : {"helmert", "molodensky", "molobadekas", "geogoffset", "deformation"})
      if (std::string_view(steps).find(step) != std::string_view::npos) return true;
    return false;
  }

  // Returns the first grid of a way that is not on this machine; empty if all are.
  std::string missing_grid_of(const PJ& way) const {
    for (int i = 0; i < proj_coordoperation_get_grid_used_count(context_.get(), &way); ++i) {
      const char* name = nullptr;
      int is_available = 0;
      if (proj_coordoperation_get_grid_used(context_.get(), &way, i, &name, nullptr, nullptr, nullptr,
                                            nullptr, nullptr, &is_available) != 0 &&
          is_available == 0)
        return name;
    }
    return "";
  }

 private:
  Owned<PJ> system_of(const OGRSpatialReference& crs) const {
    const char* const as_text[] = {"FORMAT=WKT2_2019", nullptr};
    char* text = nullptr;
    crs.exportToWkt(&text, as_text);
    Owned<PJ> system(text == nullptr ? nullptr : proj_create(context_.get(), text));
    CPLFree(text);
    return system;
  }

  Owned<PJ_CONTEXT> context_;
  Owned<PJ> from_, to_;
  Eigen::Vector3d degrees_;
};

}  // namespace

ConversionAccuracy accuracy_of(const OGRSpatialReference& from, const OGRSpatialReference& to,
                               const Eigen::Vector3d& place) {
  ConversionAccuracy accuracy;
  OGRSpatialReference system = from;
  Eigen::Vector3d degrees = place;
  const DegreesConversion conversion = conversion_to_degrees(system);
  if (!conversion.plan || !convert_to_degrees(conversion, degrees)) return accuracy;
  const Ways ways(system, to, degrees);
  const Owned<PJ> taken = ways.best(false), best = ways.best(true);
  if (!taken) return accuracy;
  accuracy.metres = ways.accuracy_of(*taken);
  accuracy.moves_datum = ways.moves_datum(*taken);
  if (!best || !(ways.accuracy_of(*best) < accuracy.metres)) return accuracy;
  accuracy.with_grid = ways.accuracy_of(*best);
  accuracy.missing_grid = ways.missing_grid_of(*best);
  return accuracy;
}

extern "C" bool lacuna_find_degrees_accuracy(const std::string& crs, const Eigen::Vector3d& place,
                                             ConversionAccuracy& accuracy) {
  const GdalFailures failures;
  OGRSpatialReference from, to;
  if (!read_crs(crs, from) || to.importFromEPSG(4326) != OGRERR_NONE) return false;
  if (from.IsGeocentric() == 0) from.StripVertical();
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  accuracy = accuracy_of(from, to, place);
  return true;
}

namespace {

std::string text_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  std::string known;
  if (crs.exportToWkt(&text) == OGRERR_NONE) known = text;
  CPLFree(text);
  return known;
}

}  // namespace

extern "C" void lacuna_look_up_crs(const std::string& given, CrsFacts& facts) {
  GdalFailures failures;
  OGRSpatialReference crs;
  facts.is_whole = read_exact_crs(given, crs);
  facts.reason = failures.first();
  if (!facts.is_whole && !read_crs(given, crs)) return;
  facts.known_text = text_of(crs);
  facts.has_positions = crs.IsVertical() == 0 || crs.IsCompound() != 0;
  facts.is_geographic = crs.IsGeographic() != 0;
  facts.is_geocentric = crs.IsGeocentric() != 0;
  if (facts.has_positions && !facts.is_geographic) facts.metres = crs.GetLinearUnits();
  if (crs.IsVertical() != 0) facts.metres_of_z = crs.GetTargetLinearUnits("VERT_CS");
  if (crs.IsCompound() != 0) crs.StripVertical();
  facts.horizontal = text_of(crs);
  const char *const owner = crs.GetAuthorityName(nullptr), *const code = crs.GetAuthorityCode(nullptr);
  if (owner != nullptr && code != nullptr && std::string_view(owner) == "EPSG")
    facts.code = std::string("EPSG:") + code;
}

extern "C" bool lacuna_find_scale(const std::string& crs, const Eigen::Vector3d& place,
                                  ProjectionScale& scale) {
  const GdalFailures failures;
  OGRSpatialReference system;
  if (!read_crs(crs, system) || system.IsProjected() == 0) return false;
  const double metre = system.GetLinearUnits();
  const auto conversion = conversion_to_degrees(system);
  if (!conversion.plan) return false;
  const double half = 50 / metre;  // of a step that is short for an ellipsoid and long for rounding
  const auto at = [&](double x, double y, Eigen::Vector3d& degrees) {
    degrees = {place.x() + x, place.y() + y, 0};
    return convert_to_degrees(conversion, degrees);
  };
  Eigen::Vector3d here, west, east, south, north;
  if (!at(0, 0, here) || !at(-half, 0, west) || !at(half, 0, east) || !at(0, -half, south) ||
      !at(0, half, north))
    return false;
  scale.longitude = here.x();
  scale.latitude = here.y();
  // Radii of curvature of WGS 84: along the parallel, and along the meridian.
  constexpr double kRadian = std::numbers::pi / 180, kAxis = 6378137, kSquare = 0.00669437999014;
  const double sine = std::sin(here.y() * kRadian), w = 1 - kSquare * sine * sine;
  const double along_parallel = kAxis / std::sqrt(w) * std::cos(here.y() * kRadian);
  const double along_meridian = kAxis * (1 - kSquare) / (w * std::sqrt(w));
  const auto scale_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double turn = std::remainder(to.x() - from.x(), 360);
    const double length =
        std::hypot(turn * kRadian * along_parallel, (to.y() - from.y()) * kRadian * along_meridian);
    return 2 * half * metre / length;
  };
  scale.scale_x = scale_of(west, east);
  scale.scale_y = scale_of(south, north);
  return std::isfinite(scale.scale_x) && std::isfinite(scale.scale_y);
}

extern "C" bool lacuna_is_same_crs(const std::string& a, const std::string& b) {
  const GdalFailures failures;
  OGRSpatialReference first, second;
  return read_crs(a, first) && read_crs(b, second) && first.IsSame(&second) != 0;
}

extern "C" bool lacuna_convert_to_degrees(const std::string& crs, std::span<Eigen::Vector3d> places) {
  const GdalFailures failures;
  OGRSpatialReference system;
  if (!read_crs(crs, system)) return false;
  const auto conversion = conversion_to_degrees(system);
  return conversion.plan && std::all_of(places.begin(), places.end(), [&](Eigen::Vector3d& place) {
           return convert_to_degrees(conversion, place);
         });
}

}  // namespace lacuna::io
