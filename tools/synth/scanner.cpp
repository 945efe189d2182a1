#include "tools/synth/scanner.hpp"

#include "engine/run/error.hpp"
#include "tools/synth/trig.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::synth {

namespace {

constexpr double kLowest = -60.0 / 360;   // turns: the tripod hides what is below
constexpr double kUpright = 150.0 / 360;  // turns from the lowest to the zenith
constexpr double kWobble = 0.1;           // of a step, uniform: no mechanism is perfect
constexpr double kGrazing = 0.03;         // cosine below which nothing comes back
constexpr double kFullIntensity = 2;      // metres: white at this range, seen squarely, has intensity 1
constexpr double kClearance = 0.6;        // metres between a station and any thing

enum Stream : std::uint64_t { kPlaces = 16, kAims, kRanges, kStrays, kProbes };

struct Ray {
  std::uint32_t station;
  double azimuth, elevation;  // turns
};

// Equal steps of azimuth and elevation from every station.
struct Rays {
  std::uint64_t scanlines, per_scanline;  // per station
  std::uint32_t stations;

  std::uint64_t count() const { return scanlines * per_scanline * stations; }
};

struct Echo {
  Vec3 position;
  float intensity;
};

void require(bool holds, const std::string& message) {
  if (!holds) throw Error(message);
}

void check(const ScanOptions& o) {
  require(o.points >= 1 && o.points <= 1'000'000'000'000, "--points: must be 1 to 1e12");
  require(o.stations >= 1 && o.stations <= 255, "--stations: must be 1 to 255");
  require(o.noise >= 0 && o.noise <= 10, "--noise: must be 0 to 10 metres");
  require(o.outliers >= 0 && o.outliers <= 1, "--outliers: must be 0 to 1");
  require(o.max_range >= 1 && o.max_range <= 1e6, "--max-range: must be 1 to 1e6 metres");
  for (const double offset : o.translate) {
    require(std::fabs(offset) <= 1e12, "--translate: must be within 1e12 metres");
    require(o.coordinates == Coordinates::kDouble || std::fabs(offset) <= 10'000,
            "--translate: floats are too coarse that far out; add --double");
  }
}

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

class Scanner {
 public:
  explicit Scanner(const ScanOptions& options)
      : options_(options),
        scene_(make_scene(options.scene)),
        stations_(place_stations(scene_, options)),
        range_(options.seed, kRanges),
        stray_(options.seed, kStrays) {}

  // What comes back from the `index`-th ray.
  std::optional<Echo> measure(const Ray& ray, std::uint64_t index) const {
    const auto [sin_azimuth, cos_azimuth] = sin_cos(ray.azimuth);
    const auto [sin_elevation, cos_elevation] = sin_cos(ray.elevation);
    const Vec3 direction{cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation};
    const Vec3 eye = stations_[ray.station];
    const Hit hit = cast(scene_, eye, direction);
    if (hit.range > options_.max_range || hit.reflectance == 0 || hit.cosine < kGrazing) return std::nullopt;
    double range = hit.range + options_.noise * range_.normal(index);
    if (stray_.uniform(2 * index) < options_.outliers)
      range = hit.range * stray_.uniform(2 * index + 1, 0.1, 1);
    const double fading = kFullIntensity / hit.range;
    const double intensity = std::min(1.0, hit.reflectance * hit.cosine * fading * fading);
    const auto [x, y, z] = options_.translate;
    return Echo{eye + range * direction + Vec3{x, y, z}, static_cast<float>(intensity)};
  }

  // So many, in equal steps both ways, that about `options.points` return.
  Rays lay_rays() const {
    constexpr std::uint64_t kProbesPerStation = 20'000;
    const Random random(options_.seed, kProbes);
    std::uint64_t returned = 0;
    const std::uint64_t probes = kProbesPerStation * options_.stations;
    for (std::uint64_t probe = 0; probe < probes; ++probe) {
      const Ray ray{static_cast<std::uint32_t>(probe % options_.stations), random.uniform(2 * probe),
                    kLowest + kUpright * random.uniform(2 * probe + 1)};
      if (measure(ray, probe)) ++returned;
    }
    require(returned > 0, "--max-range: no ray reaches anything");
    const double per_station = static_cast<double>(options_.points) / options_.stations *
                               static_cast<double>(probes) / static_cast<double>(returned);
    const double scanlines = std::floor(std::sqrt(per_station / kUpright) + 0.5);
    return {.scanlines = static_cast<std::uint64_t>(std::max(scanlines, 1.0)),
            .per_scanline = static_cast<std::uint64_t>(
                std::max(std::floor(per_station / std::max(scanlines, 1.0) + 0.5), 1.0)),
            .stations = options_.stations};
  }

 private:
  ScanOptions options_;
  Scene scene_;
  std::vector<Vec3> stations_;
  Random range_, stray_;
};

Ray aim(const Rays& rays, const Random& wobble, std::uint64_t index) {
  const std::uint64_t line = index / rays.per_scanline;
  const std::uint64_t station = line / rays.scanlines;
  const double across =
      static_cast<double>(line % rays.scanlines) + wobble.uniform(2 * index, -kWobble, kWobble);
  const double up =
      static_cast<double>(index % rays.per_scanline) + 0.5 + wobble.uniform(2 * index + 1, -kWobble, kWobble);
  return {.station = static_cast<std::uint32_t>(station),
          .azimuth = across / static_cast<double>(rays.scanlines),
          .elevation = kLowest + kUpright * (up / static_cast<double>(rays.per_scanline))};
}

}  // namespace

ScanSummary write_scan(const ScanOptions& options) {
  check(options);
  OutputSet set(options.overwrite);
  PlyOutput ply(set.add(options.out, kScanMark), options.coordinates, Extras::kScanAndIntensity);
  const Scanner scanner(options);
  const Rays rays = scanner.lay_rays();
  const Random wobble(options.seed, kAims);
  const Permutation shuffled(rays.count(), options.seed);

  for (std::uint64_t turn = 0; turn < rays.count(); ++turn) {
    const std::uint64_t index = options.order == Order::kRandom ? shuffled(turn) : turn;
    const Ray ray = aim(rays, wobble, index);
    if (const auto echo = scanner.measure(ray, index))
      ply.add(echo->position, static_cast<std::uint8_t>(ray.station), echo->intensity);
  }
  ply.finish();
  set.commit();
  return {.points = ply.count(), .rays = rays.count()};
}

}  // namespace lacuna::synth
