// SPDX-License-Identifier: Apache-2.0
#include "tests/io/stations/true_causes.hpp"

#include "bench/synth/scanner.hpp"
#include "io/explain/stations/find_causes.hpp"

namespace lacuna::test {
namespace {

using namespace synth;

constexpr double kNear = 0.05;  // metres from a place to a surface

Vec3 vec3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Where the normal through a place hits a shape, if that is near.
std::optional<ScenePoint> on_surface(const Scene& scene, const io::InnerSample& place) {
  std::optional<ScenePoint> nearest;
  double least = kNear;
  for (const double side : {1.0, -1.0}) {
    const Vec3 normal = side * vec3(place.normal);
    const Hit hit = cast(scene, {vec3(place.position) + kNear * normal, -1 * normal});
    const double away = std::fabs(hit.range - kNear);
    if (!(away < least)) continue;
    least = away;
    nearest = ScenePoint{.position = vec3(place.position) + (kNear - hit.range) * normal,
                         .normal = normal,
                         .shape = hit.shape,
                         .two_sided = true};
  }
  return nearest;
}

// None: the station samples it.
std::optional<io::Cause> cause_of(const synth::Cause& cause, bool is_grazing) {
  switch (cause.kind) {
    case synth::Cause::kNone:
      return std::nullopt;
    case synth::Cause::kEdge:
      return is_grazing ? io::Cause::kOutOfView : io::Cause::kHidden;
    case synth::Cause::kShadow:
      return io::Cause::kHidden;
    case synth::Cause::kWindow:
    case synth::Cause::kDoor:
      return io::Cause::kOpening;
    case synth::Cause::kWater:
      return io::Cause::kNoReturn;
    default:
      return io::Cause::kOutOfView;
  }
}

// As find_causes combines stations.
int rank_of(io::Cause cause) {
  return cause == io::Cause::kOpening ? 0 : cause == io::Cause::kNoReturn ? 1 : 2;
}

}  // namespace

bool is_on_surface(const io::InnerSample& place, const Scanner& scanner) {
  return on_surface(scanner.scene(), place).has_value();
}

double area_seen_by_last(std::span<const io::InnerSample> places, const Scanner& scanner) {
  const Visibility last = Visibility(scanner).only(static_cast<std::uint32_t>(scanner.stations().size() - 1));
  double area = 0;
  for (const io::InnerSample& place : places) {
    const std::optional<ScenePoint> surface = on_surface(scanner.scene(), place);
    if (surface && last.any(*surface)) area += place.area;
  }
  return area;
}

std::array<double, io::kCauses> true_shares(std::span<const io::InnerSample> places, const Scanner& scanner) {
  std::array<double, io::kCauses> shares{};
  double all = 0;
  const Visibility visibility(scanner);
  for (const io::InnerSample& place : places) {
    const std::optional<ScenePoint> surface = on_surface(scanner.scene(), place);
    std::optional<io::Cause> found;
    double nearest = 0;
    bool is_sampled = false;
    for (std::uint32_t number = 0; number < scanner.sweeps().size(); ++number) {
      const Vec3 arm = vec3(place.position) - scanner.eye(scanner.sweeps()[number], vec3(place.position));
      const double range = std::sqrt(dot(arm, arm));
      if (!surface) {  // a door, or bent away from all surfaces
        if (std::isinf(cast(scanner.scene(), {vec3(place.position) - arm, (1 / range) * arm}).range))
          found = io::Cause::kOpening;
        continue;
      }
      const bool is_grazing = std::fabs(dot(arm, surface->normal)) / range < io::kLeastIncidence;
      const auto cause = cause_of(visibility.cause(*surface, number), is_grazing);
      is_sampled = is_sampled || !cause;
      if (!cause) break;
      if (found && std::pair(rank_of(*found), nearest) <= std::pair(rank_of(*cause), range)) continue;
      found = cause;
      nearest = range;
    }
    if (is_sampled || !found) continue;
    shares[static_cast<std::size_t>(*found)] += place.area;
    all += place.area;
  }
  if (all > 0)
    for (double& share : shares) share /= all;
  return shares;
}

}  // namespace lacuna::test
