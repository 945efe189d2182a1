// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/scanner.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacuna::synth {

namespace {

constexpr double kWobble = 0.1;       // of a step, uniform: no mechanism is perfect
constexpr double kFullIntensity = 2;  // metres: white at this range, hit squarely, has intensity 1
constexpr double kClearance = 0.6;    // metres between a station and any thing
constexpr double kLeverArm = 10;      // metres at which an error of heading counts as much as one of place
constexpr double kTilt = 25 / 360.0;  // turns, of the axis of each of several sweeps
constexpr double kGolden = 0.6180339887498949;
constexpr double kFlightWobble = 0.4;  // of a step: a platform in the air sways
constexpr double kSwath = 20 / 360.0;  // turns, to each side of a strip
constexpr double kHalfSwath = 0.6;     // distances of strips: neighbours overlap by a fifth of them
constexpr double kDriveRange = 5;      // metres at which profiles of a drive are as far apart as their points
constexpr double kPause = 5;           // seconds between strips
constexpr double kLeafReflectance = 0.2;

constexpr double kSamePlace = 1e-5;       // metres along the ray
constexpr double kLeastIncidence = 0.25;  // cosines, in the spacing
constexpr double kLeastElevation = 0.3;

enum Stream : std::uint64_t { kPlaces = 16, kAims, kRanges, kStrays, kProbes, kRegistrations, kCrowns };

// Spreads places over the floor by the plane's golden ratio (R2 sequence, Roberts 2018), clear of all things.
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
  for (std::size_t i = 0; i + 2 < options.places.size(); i += 3)
    stations.push_back({options.places[i], options.places[i + 1], options.places[i + 2]});
  return stations;
}

// Returns the middles of lanes or strips at equal distances over the ground where stations may be. Strips are
// as high as their swaths need to overlap.
std::vector<Vec3> place_strips(const Scene& scene, const ScanOptions& options) {
  const double distance = (scene.stand_high.y - scene.stand_low.y) / options.stations;
  const auto [sine, cosine] = sin_cos(kSwath);
  const double shift = scene.flown ? Random(options.seed, kPlaces).uniform(0, -0.05, 0.05) : 0;
  const double height = scene.flown ? kHalfSwath * distance * cosine / sine : 0;
  std::vector<Vec3> middles;
  for (std::uint32_t strip = 0; strip < options.stations; ++strip) {
    middles.push_back({0.5 * (scene.stand_low.x + scene.stand_high.x),
                       scene.stand_low.y + (strip + 0.5 + shift) * distance, scene.stand_low.z + height});
  }
  return middles;
}

}  // namespace

Scanner::Scanner(const ScanOptions& options, Scene scene)
    : options_(options),
      scene_(std::move(scene)),
      lowest_(scene_.flown     ? -kSwath
              : options.drives ? -0.5
                               : options.field_of_view[0] / 360),
      upright_(scene_.flown     ? 2 * kSwath
               : options.drives ? 1
                                : (options.field_of_view[1] - options.field_of_view[0]) / 360),
      max_range_(scene_.flown ? std::numeric_limits<double>::max() : options.max_range),
      wobble_(options.seed, kAims),
      range_(options.seed, kRanges),
      stray_(options.seed, kStrays),
      leaves_(options.seed, kCrowns),
      stations_(moves() ? place_strips(scene_, options) : place_stations(scene_, options)) {
  if (options_.registration > 0) misplace_stations();
  lay_sweeps();
  lay_rays();
}

// The other stations are registered to the first one.
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

// One sweep is upright. Several are tilted by the same angle, each to another side.
void Scanner::lay_sweeps() {
  for (std::uint32_t station = 0; station < stations_.size(); ++station) {
    for (std::uint32_t sweep = 0; sweep < options_.sweeps; ++sweep) {
      Sweep& laid = sweeps_.emplace_back(Sweep{.station = station,
                                               .origin = stations_[station],
                                               .x = {1, 0, 0},
                                               .y = {0, 1, 0},
                                               .axis = {0, 0, 1}});
      if (options_.sweeps == 1) continue;
      const auto [tilt_sine, tilt_cosine] = sin_cos(kTilt);
      const auto [sine, cosine] = sin_cos(static_cast<double>(sweep) / options_.sweeps + kGolden * station);
      laid.x = {tilt_cosine * cosine, tilt_cosine * sine, -tilt_sine};
      laid.y = {-sine, cosine, 0};
      laid.axis = {tilt_sine * cosine, tilt_sine * sine, tilt_cosine};
    }
  }
}

Vec3 Scanner::eye(const Sweep& sweep, Vec3 place) const {
  return moves() ? sweep.origin + dot(place - sweep.origin, sweep.x) * sweep.x : sweep.origin;
}

Beam Scanner::beam(const Ray& ray) const {
  const Sweep& sweep = sweeps_[ray.sweep];
  const auto [sin_elevation, cos_elevation] = sin_cos(ray.elevation);
  if (moves()) {
    return {sweep.origin + (ray.azimuth - 0.5) * strip_length() * sweep.x,
            sin_elevation * sweep.y - cos_elevation * sweep.axis};
  }
  const auto [sin_azimuth, cos_azimuth] = sin_cos(ray.azimuth);
  return {sweep.origin, cos_elevation * cos_azimuth * sweep.x + cos_elevation * sin_azimuth * sweep.y +
                            sin_elevation * sweep.axis};
}

// Returns where leaves stop the ray, in each crown after a uniformly random way; `range` if none does.
double Scanner::range_in_leaves(const Beam& beam, double range, std::uint64_t index) const {
  double nearest = range;
  for (std::size_t crown = 0; crown < scene_.foliage.size(); ++crown) {
    const Foliage& foliage = scene_.foliage[crown];
    const auto [from, to] = way_through(foliage, beam);
    if (from >= to) continue;
    const double stop = from + foliage.depth * leaves_.uniform(scene_.foliage.size() * index + crown);
    if (stop < to) nearest = std::min(nearest, stop);
  }
  return nearest;
}

// Returns the echo of the `index`-th ray.
std::optional<Echo> Scanner::measure(const Ray& ray, std::uint64_t index) const {
  const Beam beam = this->beam(ray);
  Hit hit = cast(scene_, beam);
  if (const double range = range_in_leaves(beam, hit.range, index); range < hit.range)
    hit = {range, 1, kLeafReflectance, kLeaves};
  if (hit.range > max_range_ || hit.reflectance == 0 || hit.cosine < kGrazing) return std::nullopt;
  double range = hit.range + options_.noise * range_.normal(index);
  const bool stray = stray_.uniform(2 * index) < options_.outliers;
  if (stray) range = hit.range * stray_.uniform(2 * index + 1, 0.1, 1);
  const double fading = kFullIntensity / hit.range;
  const auto [x, y, z] = options_.translate;
  return Echo{.position = registered(beam.origin + range * beam.direction, sweeps_[ray.sweep].station) +
                          Vec3{x, y, z},
              .place = beam.origin + hit.range * beam.direction,
              .intensity = std::min(1.0, hit.reflectance * hit.cosine * fading * fading),
              .shape = hit.shape,
              .stray = stray};
}

double Scanner::strip_start(std::uint32_t strip) const {
  return strip * (strip_length() / kSpeed + kPause);
}

double Scanner::time(const Ray& ray) const {
  return strip_start(sweeps_[ray.sweep].station) + ray.azimuth * strip_length() / kSpeed;
}

std::uint64_t Scanner::rays() const {
  const Sweep& last = sweeps_.back();
  return last.first_ray + last.scanlines * last.per_scanline;
}

// Chooses the number of equal steps so that about `options.points` rays return.
void Scanner::lay_rays() {
  constexpr std::uint64_t kProbesPerSweep = 20'000;
  const Random random(options_.seed, kProbes);
  std::uint64_t returned = 0;
  const std::uint64_t probes = kProbesPerSweep * sweeps_.size();
  for (std::uint64_t probe = 0; probe < probes; ++probe) {
    const Ray ray{static_cast<std::uint32_t>(probe % sweeps_.size()), random.uniform(2 * probe),
                  lowest_ + upright_ * random.uniform(2 * probe + 1)};
    if (measure(ray, probe)) ++returned;
  }
  if (returned == 0) throw UsageError("--max-range: no ray reaches anything");
  const auto weight = [&](const Sweep& sweep) { return sweep.station == 0 ? options_.station_factor : 1; };
  double weights = 0;
  for (const Sweep& sweep : sweeps_) weights += weight(sweep);
  // Height over width of the field of rays.
  const double aspect = scene_.flown
                            ? upright_ * kTwoPi * (stations_[0].z - scene_.stand_low.z) / strip_length()
                        : options_.drives ? kTwoPi * kDriveRange / strip_length()
                                          : upright_;
  std::uint64_t first = 0;
  for (Sweep& sweep : sweeps_) {
    const double rays = static_cast<double>(options_.points) * weight(sweep) / weights *
                        static_cast<double>(probes) / static_cast<double>(returned);
    const double scanlines = std::floor(std::sqrt(rays / aspect * options_.ring_ratio) + 0.5);
    sweep.scanlines = static_cast<std::uint64_t>(std::max(scanlines, 1.0));
    sweep.per_scanline =
        static_cast<std::uint64_t>(std::max(std::floor(rays / std::max(scanlines, 1.0) + 0.5), 1.0));
    sweep.first_ray = first;
    first += sweep.scanlines * sweep.per_scanline;
  }
}

// Rings that are far apart wobble no more than the points on them.
Ray Scanner::ray(std::uint64_t index) const {
  const double wobble = scene_.flown ? kFlightWobble : kWobble;
  const double rise = wobble / std::max(1.0, options_.ring_ratio);
  const auto after =
      std::upper_bound(sweeps_.begin(), sweeps_.end(), index,
                       [](std::uint64_t ray, const Sweep& sweep) { return ray < sweep.first_ray; });
  const Sweep& sweep = *(after - 1);
  const std::uint64_t own = index - sweep.first_ray;
  const double across =
      static_cast<double>(own / sweep.per_scanline) + wobble_.uniform(2 * index, -wobble, wobble);
  const double up =
      static_cast<double>(own % sweep.per_scanline) + 0.5 + wobble_.uniform(2 * index + 1, -rise, rise);
  return {.sweep = static_cast<std::uint32_t>(after - sweeps_.begin() - 1),
          .azimuth = across / static_cast<double>(sweep.scanlines),
          .elevation = lowest_ + upright_ * (up / static_cast<double>(sweep.per_scanline))};
}

// ---- Which places are sampled

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

Visibility Visibility::part(std::uint32_t station, bool is_of_station) const {
  Visibility part = *this;
  std::erase_if(part.sweeps_, [&](std::uint32_t sweep) {
    return (scanner_.sweeps()[sweep].station == station) != is_of_station;
  });
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
