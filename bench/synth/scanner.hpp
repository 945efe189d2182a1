// SPDX-License-Identifier: Apache-2.0
// A virtual laser scanner: at several stations on the ground, or moving in strips over the scene or on the
// ground.
#pragma once

#include "bench/synth/random.hpp"
#include "bench/synth/scan_options.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace lacuna::synth {

// Angles are in turns. On a strip, the azimuth is a share of the strip's length. The elevation is the angle
// from straight down, around the strip.
struct Ray {
  std::uint32_t sweep;
  double azimuth, elevation;
};

// Equal steps of azimuth and elevation around an axis. Each station has one or several sweeps, each strip
// one.
struct Sweep {
  std::uint32_t station;
  Vec3 origin;      // of a strip: the middle
  Vec3 x, y, axis;  // unit, at right angles; a strip runs along x
  std::uint64_t scanlines = 0, per_scanline = 0;
  std::uint64_t first_ray = 0;
};

struct Echo {
  Vec3 position;  // as measured: with noise, errors of registration and translation
  Vec3 place;     // on the scene's surface, or in leaves
  double intensity;
  std::uint32_t shape;  // Hit::shape; kLeaves
  bool stray;           // anywhere on its ray
};

inline constexpr std::uint32_t kLeaves = std::numeric_limits<std::uint32_t>::max();

// Every ray and every echo is a function of the seed and the ray's index alone.
class Scanner {
 public:
  // Nothing comes back below this cosine of the angle of incidence.
  static constexpr double kGrazing = 0.03;
  // From the air, rays hit walls at less than this cosine. Walls have a few points, too few for a surface.
  static constexpr double kGrazingFromAir = 0.35;

  // Throws `Error` when no ray returns anything.
  Scanner(const ScanOptions& options, Scene scene);

  const Scene& scene() const { return scene_; }
  const std::vector<Vec3>& stations() const { return stations_; }
  const std::vector<Sweep>& sweeps() const { return sweeps_; }
  std::uint64_t rays() const;
  double lowest() const { return lowest_; }              // turns
  double highest() const { return lowest_ + upright_; }  // turns
  double max_range() const { return max_range_; }
  // A surface counts as sampled from this cosine of the angle of incidence on.
  double least_cosine() const { return scene_.flown ? kGrazingFromAir : kGrazing; }
  bool moves() const { return scene_.flown || options_.drives; }
  double strip_length() const { return scene_.stand_high.x - scene_.stand_low.x; }
  // `time` returns the seconds at which a ray of a strip starts. Strips follow each other, at kSpeed, with
  // pauses.
  static constexpr double kSpeed = 10;  // metres a second
  double time(const Ray& ray) const;
  double strip_start(std::uint32_t strip) const;

  // Returns where the ray of a sweep to this place starts.
  Vec3 eye(const Sweep& sweep, Vec3 place) const;

  Ray ray(std::uint64_t index) const;
  std::optional<Echo> measure(const Ray& ray, std::uint64_t index) const;

 private:
  struct Misplacement {
    Vec3 shift;
    double sine, cosine;  // of the turn about the upright axis through the station
  };
  void misplace_stations();
  void lay_sweeps();
  void lay_rays();
  Beam beam(const Ray& ray) const;
  double range_in_leaves(const Beam& beam, double range, std::uint64_t index) const;
  Vec3 registered(Vec3 position, std::uint32_t station) const;

  ScanOptions options_;
  Scene scene_;
  double lowest_, upright_, max_range_;
  Random wobble_, range_, stray_, leaves_;
  std::vector<Vec3> stations_;
  std::vector<Misplacement> misplaced_;  // of each station; empty if none is misplaced
  std::vector<Sweep> sweeps_;            // station after station
};

}  // namespace lacuna::synth
