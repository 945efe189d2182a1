// SPDX-License-Identifier: Apache-2.0
#include "io/area/trace_voids.hpp"

#include "engine/run/error.hpp"

#include <memory>

#include <geos_c.h>
#include <ogr_geometry.h>

namespace lacuna::io {
namespace {

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
  const LargestCircle circle;
  polygonise(task.raster, [&](std::uint8_t value, const OGRPolygon& polygon) {
    TracedVoid& traced = task.voids.emplace_back(TracedVoid{value, outline_of(polygon)});
    if (!circle.find(polygon, traced)) throw Error("outlines of voids: GEOS finds no largest circle");
  });
}

}  // namespace lacuna::io
