// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/conversion_accuracy.hpp"

#include "io/read/crs/gdal_session.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string_view>

#include <cpl_conv.h>
#include <ogr_spatialref.h>
#include <proj.h>

namespace lacuna::io {
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

}  // namespace lacuna::io
