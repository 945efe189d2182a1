// SPDX-License-Identifier: Apache-2.0
// scanner: a virtual laser scanner, at several stations on the ground, or moving in strips over the scene or
// on the ground. And from which stations a place of the scene's surface is sampled, and why not from the
// others.
//
// Idea: every ray and every echo is a function of the seed and the ray's index alone. Whether a place is
// sampled is known without its rays: from the field of view, the angle of incidence, and what is in the way.
//
// Source: stations stand at places of the R2 sequence (Roberts 2018). Cost: a step for each shape of the
// scene.
#pragma once

#include "bench/synth/scan.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
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

// Why a station does not sample a place.
struct Cause {
  enum Kind : std::uint8_t {
    kNone,
    kEdge,    // the surface of the shape ends there, or turns away
    kShadow,  // of the shape
    kWindow,
    kDoor,
    kWater,
    kBelow,  // the field of view of the station
    kAbove,
    kStrip,  // to a side of it, or past its ends
    kFar
  } kind = kNone;
  std::uint32_t number = 0;  // of the shape, or of the station

  friend bool operator==(const Cause&, const Cause&) = default;
  friend auto operator<=>(const Cause&, const Cause&) = default;
};

// Returns the cause as a person would say it.
std::string in_words(const Cause& cause, const Scene& scene);

struct ScenePoint {
  Vec3 position, normal;
  std::uint32_t shape;
  bool two_sided;
};

class Visibility {
 public:
  // Uses the sweeps of all stations.
  explicit Visibility(const Scanner& scanner);

  // These use the sweeps of one station, or of all other stations.
  Visibility only(std::uint32_t station) const { return part(station, true); }
  Visibility without(std::uint32_t station) const { return part(station, false); }

  // Returns numbers in Scanner::sweeps().
  const std::vector<std::uint32_t>& sweeps() const { return sweeps_; }

  // The cause is kNone if the sweep samples the place.
  Cause cause(const ScenePoint& place, std::uint32_t sweep) const;

  // Returns the normal on the side of the first station that samples the place; empty if no station does.
  std::optional<Vec3> facing(const ScenePoint& place) const;
  bool any(const ScenePoint& place) const { return facing(place).has_value(); }

  // Returns the points per square metre that one sweep leaves around the place; 0 if the sweep does not
  // sample it.
  double density(const ScenePoint& place, std::uint32_t sweep) const;

  // Returns the mean distance of the points that all sweeps leave around the place; 0 if none samples it. For
  // a scanner with rings it is the distance of the rings. Grazing rays and rays near the zenith count as less
  // grazing ones, since their points lie close in one direction only.
  double spacing(const ScenePoint& place) const;

 private:
  Visibility part(std::uint32_t station, bool is_of_station) const;

  const Scanner& scanner_;
  double lowest_, highest_;  // sines of the elevation
  std::vector<std::uint32_t> sweeps_;
};

}  // namespace lacuna::synth
