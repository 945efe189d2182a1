// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/visibility.hpp"

#include "bench/synth/trig.hpp"

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
    case Cause::kWater:
      return "water";
    case Cause::kStrip:
      return "side of strip " + std::to_string(cause.number);
    case Cause::kFar:
      return "out of range";
    case Cause::kNone:
      break;
  }
  return "gap";
}

Visibility::Visibility(const Scanner& scanner)
    : scanner_(scanner), lowest_(sin_cos(scanner.lowest()).sin), highest_(sin_cos(scanner.highest()).sin) {
  if (scanner.highest() - scanner.lowest() == 1) lowest_ = -1, highest_ = 1;  // a whole turn

  for (std::uint32_t sweep = 0; sweep < scanner.sweeps().size(); ++sweep) sweeps_.push_back(sweep);
}

Visibility Visibility::only(std::uint32_t station) const {
  Visibility part = *this;
  std::erase_if(part.sweeps_, [&](std::uint32_t s) { return scanner_.sweeps()[s].station != station; });
  return part;
}

Visibility Visibility::without(std::uint32_t station) const {
  Visibility part = *this;
  std::erase_if(part.sweeps_, [&](std::uint32_t s) { return scanner_.sweeps()[s].station == station; });
  return part;
}

Cause Visibility::cause(const ScenePoint& place, std::uint32_t number) const {
  const Scene& scene = scanner_.scene();
  const Sweep& sweep = scanner_.sweeps()[number];
  const Vec3 eye = scanner_.eye(sweep, place.position);
  const Vec3 arm = place.position - eye;
  const double range = std::sqrt(dot(arm, arm));
  const Vec3 direction = (1 / range) * arm;
  const double facing = -dot(direction, place.normal);
  const double elevation = dot(direction, scene.flown ? sweep.y : sweep.axis);
  const bool is_ahead =
      scanner_.moves() && 2 * std::fabs(dot(eye - sweep.origin, sweep.x)) > scanner_.strip_length();
  if (is_ahead) return {Cause::kStrip, sweep.station};
  if (elevation < lowest_) return {scene.flown ? Cause::kStrip : Cause::kBelow, sweep.station};
  if (elevation > highest_) return {scene.flown ? Cause::kStrip : Cause::kAbove, sweep.station};
  if (range > scanner_.max_range()) return {Cause::kFar, sweep.station};
  if ((place.two_sided ? std::fabs(facing) : facing) < scanner_.least_cosine())
    return {Cause::kEdge, place.shape};
  const Hit hit = cast(scene, {eye, direction});
  if (hit.range > range + kSamePlace) return {Cause::kDoor, place.shape};
  if (hit.reflectance == 0 && scene.is_wall(hit.shape)) return {Cause::kWindow, hit.shape};
  if (hit.reflectance == 0 && scene.is_terrain(hit.shape)) return {Cause::kWater, hit.shape};
  if (hit.shape != place.shape) return {Cause::kShadow, hit.shape};
  if (hit.range < range - kSamePlace) return {Cause::kEdge, place.shape};
  return {};
}

bool Visibility::any(const ScenePoint& place) const {
  return std::any_of(sweeps_.begin(), sweeps_.end(),
                     [&](std::uint32_t sweep) { return cause(place, sweep).kind == Cause::kNone; });
}

std::optional<Vec3> Visibility::facing(const ScenePoint& place) const {
  for (const std::uint32_t sweep : sweeps_) {
    if (cause(place, sweep).kind != Cause::kNone) continue;
    const Vec3 eye = scanner_.eye(scanner_.sweeps()[sweep], place.position);
    return dot(eye - place.position, place.normal) < 0 ? -1 * place.normal : place.normal;
  }
  return std::nullopt;
}

double Visibility::density(const ScenePoint& place, std::uint32_t number) const {
  if (cause(place, number).kind != Cause::kNone) return 0;
  const Sweep& sweep = scanner_.sweeps()[number];
  const Scene& scene = scanner_.scene();
  const Vec3 eye = scanner_.eye(sweep, place.position);
  const Vec3 arm = place.position - eye;
  const double square = dot(arm, arm);
  const double range = std::sqrt(square);
  const double incidence = std::max(std::fabs(dot(arm, place.normal)) / range, kLeastIncidence);
  const double share =
      scene.foliage.empty() ? 1 : share_through_leaves(scene, {eye, (1 / range) * arm}, range);
  // The steps between rays are in turns around the axis, or in lengths of the strip. Elevation has its own.
  const double around = 1 / static_cast<double>(sweep.scanlines);
  const double along = (scanner_.highest() - scanner_.lowest()) / static_cast<double>(sweep.per_scanline);
  if (scanner_.moves()) {
    const double step = std::max(scanner_.strip_length() * around, range * kTwoPi * along);
    return share * incidence / (step * step);
  }
  const double step = kTwoPi * std::max(around, along);
  const double right = dot(arm, sweep.x), forward = dot(arm, sweep.y);
  const double elevation = std::max(std::sqrt(right * right + forward * forward) / range, kLeastElevation);
  return share * incidence / (square * step * step * elevation);
}

double Visibility::spacing(const ScenePoint& place) const {
  double sum = 0;
  for (const std::uint32_t sweep : sweeps_) sum += density(place, sweep);
  return sum > 0 ? 1 / std::sqrt(sum) : 0;
}

}  // namespace lacuna::synth
