#include "tools/synth/scanner.hpp"

#include "engine/run/error.hpp"
#include "tools/synth/trig.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacuna::synth {

namespace {

constexpr double kWobble = 0.1;       // of a step, uniform: no mechanism is perfect
constexpr double kFullIntensity = 2;  // metres: white at this range, seen squarely, has intensity 1
constexpr double kClearance = 0.6;    // metres between a station and any thing
constexpr double kLeverArm = 10;      // metres at which an error of heading counts as much as one of place

enum Stream : std::uint64_t { kPlaces = 16, kAims, kRanges, kStrays, kProbes, kRegistrations };

// Spread over the floor by the plane's golden ratio (R2 sequence, Roberts 2018), clear of all things.
std::vector<Vec3> place_stations(const Scene& scene, const ScanOptions& options) {
  const Random random(options.seed, kPlaces);
  const Vec3 low = scene.stand_low;
  const Vec3 high = scene.stand_high;
  std::vector<Vec3> stations;
  for (std::uint64_t turn = 0; stations.size() < options.stations; ++turn) {
    const double u = random.uniform(0) + 0.7548776662466927 * static_cast<double>(turn);
    const double v = random.uniform(1) + 0.5698402909980532 * static_cast<double>(turn);
    const Vec3 place{low.x + (u - std::floor(u)) * (high.x - low.x),
                     low.y + (v - std::floor(v)) * (high.y - low.y), low.z};
    if (!occupied(scene, place, kClearance)) stations.push_back(place);
  }
  return stations;
}

}  // namespace

Scanner::Scanner(const ScanOptions& options, Scene scene)
    : options_(options),
      scene_(std::move(scene)),
      lowest_(options.field_of_view[0] / 360),
      upright_((options.field_of_view[1] - options.field_of_view[0]) / 360),
      wobble_(options.seed, kAims),
      range_(options.seed, kRanges),
      stray_(options.seed, kStrays),
      stations_(place_stations(scene_, options)) {
  if (options_.registration > 0) misplace_stations();
  rays_ = lay_rays();
}

// The first station is where the others are registered to.
void Scanner::misplace_stations() {
  const Random random(options_.seed, kRegistrations);
  misplaced_.push_back({{0, 0, 0}, 0, 1});
  for (std::uint64_t station = 1; station < stations_.size(); ++station) {
    const auto error = [&](std::uint64_t part) {
      return options_.registration * random.normal(4 * station + part);
    };
    const auto [sine, cosine] = sin_cos(error(3) / kLeverArm / kTwoPi);
    misplaced_.push_back({{error(0), error(1), error(2)}, sine, cosine});
  }
}

Vec3 Scanner::registered(Vec3 position, std::uint32_t station) const {
  if (misplaced_.empty()) return position;
  const Misplacement& error = misplaced_[station];
  const Vec3 arm = position - stations_[station];
  return stations_[station] + error.shift +
         Vec3{error.cosine * arm.x - error.sine * arm.y, error.sine * arm.x + error.cosine * arm.y, arm.z};
}

// What comes back from the `index`-th ray.
std::optional<Echo> Scanner::measure(const Ray& ray, std::uint64_t index) const {
  const auto [sin_azimuth, cos_azimuth] = sin_cos(ray.azimuth);
  const auto [sin_elevation, cos_elevation] = sin_cos(ray.elevation);
  const Vec3 direction{cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation};
  const Vec3 eye = stations_[ray.station];
  const Hit hit = cast(scene_, eye, direction);
  if (hit.range > options_.max_range || hit.reflectance == 0 || hit.cosine < kGrazing) return std::nullopt;
  double range = hit.range + options_.noise * range_.normal(index);
  const bool stray = stray_.uniform(2 * index) < options_.outliers;
  if (stray) range = hit.range * stray_.uniform(2 * index + 1, 0.1, 1);
  const double fading = kFullIntensity / hit.range;
  const auto [x, y, z] = options_.translate;
  return Echo{.position = registered(eye + range * direction, ray.station) + Vec3{x, y, z},
              .place = eye + hit.range * direction,
              .intensity = std::min(1.0, hit.reflectance * hit.cosine * fading * fading),
              .shape = hit.shape,
              .stray = stray};
}

// So many, in equal steps, that about `options.points` return.
Rays Scanner::lay_rays() const {
  constexpr std::uint64_t kProbesPerStation = 20'000;
  const Random random(options_.seed, kProbes);
  std::uint64_t returned = 0;
  const std::uint64_t probes = kProbesPerStation * options_.stations;
  for (std::uint64_t probe = 0; probe < probes; ++probe) {
    const Ray ray{static_cast<std::uint32_t>(probe % options_.stations), random.uniform(2 * probe),
                  lowest_ + upright_ * random.uniform(2 * probe + 1)};
    if (measure(ray, probe)) ++returned;
  }
  if (returned == 0) throw UsageError("--max-range: no ray reaches anything");
  const double per_station = static_cast<double>(options_.points) / options_.stations *
                             static_cast<double>(probes) / static_cast<double>(returned);
  const double scanlines = std::floor(std::sqrt(per_station / upright_ * options_.ring_ratio) + 0.5);
  return {.scanlines = static_cast<std::uint64_t>(std::max(scanlines, 1.0)),
          .per_scanline = static_cast<std::uint64_t>(
              std::max(std::floor(per_station / std::max(scanlines, 1.0) + 0.5), 1.0)),
          .stations = options_.stations};
}

// Rings that are far apart wobble no more than the points on them.
Ray Scanner::ray(std::uint64_t index) const {
  const double rise = kWobble / std::max(1.0, options_.ring_ratio);
  const std::uint64_t line = index / rays_.per_scanline;
  const std::uint64_t station = line / rays_.scanlines;
  const double across =
      static_cast<double>(line % rays_.scanlines) + wobble_.uniform(2 * index, -kWobble, kWobble);
  const double up =
      static_cast<double>(index % rays_.per_scanline) + 0.5 + wobble_.uniform(2 * index + 1, -rise, rise);
  return {.station = static_cast<std::uint32_t>(station),
          .azimuth = across / static_cast<double>(rays_.scanlines),
          .elevation = lowest_ + upright_ * (up / static_cast<double>(rays_.per_scanline))};
}

}  // namespace lacuna::synth
