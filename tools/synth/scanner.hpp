// A virtual terrestrial laser scanner, at several stations.
#pragma once

#include "tools/synth/random.hpp"
#include "tools/synth/scan_options.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace lacuna::synth {

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
  Vec3 position;  // as measured: with noise, errors of registration and translation
  Vec3 place;     // on the scene's surface
  double intensity;
  std::uint32_t shape;  // Hit::shape
  bool stray;           // anywhere on its ray
};

// Every ray and every echo is a function of the seed and its index alone.
class Scanner {
 public:
  // Below this cosine of the angle of incidence nothing comes back.
  static constexpr double kGrazing = 0.03;

  // Throws `Error` when no ray returns anything.
  Scanner(const ScanOptions& options, Scene scene);

  const Scene& scene() const { return scene_; }
  const std::vector<Vec3>& stations() const { return stations_; }
  const Rays& rays() const { return rays_; }
  double lowest() const { return lowest_; }              // turns
  double highest() const { return lowest_ + upright_; }  // turns
  double max_range() const { return options_.max_range; }

  Ray ray(std::uint64_t index) const;
  std::optional<Echo> measure(const Ray& ray, std::uint64_t index) const;

 private:
  struct Misplacement {
    Vec3 shift;
    double sine, cosine;  // of the turn about the upright axis through the station
  };
  void misplace_stations();
  Rays lay_rays() const;
  Vec3 registered(Vec3 position, std::uint32_t station) const;

  ScanOptions options_;
  Scene scene_;
  double lowest_, upright_;
  Random wobble_, range_, stray_;
  std::vector<Vec3> stations_;
  std::vector<Misplacement> misplaced_;  // of each station; empty: none is
  Rays rays_{};
};

}  // namespace lacuna::synth
