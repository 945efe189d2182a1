#include "tools/synth/visibility.hpp"

#include "tools/synth/trig.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::synth {

namespace {

constexpr double kSamePlace = 1e-5;       // metres along the ray
constexpr double kLeastIncidence = 0.25;  // cosines, in the spacing
constexpr double kLeastElevation = 0.3;

}  // namespace

std::string in_words(const Cause& cause, const Scene& scene) {
  switch (cause.kind) {
    case Cause::kEdge:
      return std::string("edge of ") + scene.name_of(cause.number);
    case Cause::kShadow:
      return std::string("shadow of ") + scene.name_of(cause.number);
    case Cause::kWindow:
      return "window";
    case Cause::kDoor:
      return "door";
    case Cause::kBelow:
      return "tripod circle of station " + std::to_string(cause.number);
    case Cause::kAbove:
      return "zenith circle of station " + std::to_string(cause.number);
    case Cause::kFar:
      return "out of range";
    case Cause::kNone:
      break;
  }
  return "gap";
}

Visibility::Visibility(const Scanner& scanner)
    : scanner_(scanner),
      lowest_(sin_cos(scanner.lowest()).sin),
      highest_(sin_cos(scanner.highest()).sin),
      step_(kTwoPi * std::max(1 / static_cast<double>(scanner.rays().scanlines),
                              (scanner.highest() - scanner.lowest()) /
                                  static_cast<double>(scanner.rays().per_scanline))) {}

Cause Visibility::cause(const SurfacePlace& place, std::uint32_t station) const {
  const Scene& scene = scanner_.scene();
  const Vec3 eye = scanner_.stations()[station];
  const Vec3 arm = place.position - eye;
  const double range = std::sqrt(dot(arm, arm));
  const Vec3 direction = (1 / range) * arm;
  const double facing = -dot(direction, place.normal);
  if (direction.z < lowest_) return {Cause::kBelow, station};
  if (direction.z > highest_) return {Cause::kAbove, station};
  if (range > scanner_.max_range()) return {Cause::kFar, station};
  if ((place.two_sided ? std::fabs(facing) : facing) < Scanner::kGrazing) return {Cause::kEdge, place.shape};
  const Hit hit = cast(scene, eye, direction);
  if (hit.range > range + kSamePlace) return {Cause::kDoor, place.shape};
  if (hit.reflectance == 0 && hit.shape < scene.walls.size()) return {Cause::kWindow, hit.shape};
  if (hit.shape != place.shape) return {Cause::kShadow, hit.shape};
  if (hit.range < range - kSamePlace) return {Cause::kEdge, place.shape};
  return {};
}

bool Visibility::any(const SurfacePlace& place) const {
  for (std::uint32_t station = 0; station < scanner_.stations().size(); ++station)
    if (cause(place, station).kind == Cause::kNone) return true;
  return false;
}

double Visibility::density(const SurfacePlace& place, std::uint32_t station) const {
  const Vec3 arm = place.position - scanner_.stations()[station];
  const double square = dot(arm, arm);
  const double range = std::sqrt(square);
  const double incidence = std::max(std::fabs(dot(arm, place.normal)) / range, kLeastIncidence);
  const double elevation = std::max(std::sqrt(arm.x * arm.x + arm.y * arm.y) / range, kLeastElevation);
  return incidence / (square * step_ * step_ * elevation);
}

double Visibility::spacing(const SurfacePlace& place) const {
  double sum = 0;
  for (std::uint32_t station = 0; station < scanner_.stations().size(); ++station)
    if (cause(place, station).kind == Cause::kNone) sum += density(place, station);
  return sum > 0 ? 1 / std::sqrt(sum) : 0;
}

}  // namespace lacuna::synth
