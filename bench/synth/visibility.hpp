// SPDX-License-Identifier: Apache-2.0
// Decides from which stations a place of a scene's surface is sampled, and why not from the others.
#pragma once

#include "bench/synth/scanner.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::synth {

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
  Visibility only(std::uint32_t station) const;
  Visibility without(std::uint32_t station) const;

  // Returns numbers in Scanner::sweeps().
  const std::vector<std::uint32_t>& sweeps() const { return sweeps_; }

  // The cause is kNone if the sweep samples the place.
  Cause cause(const ScenePoint& place, std::uint32_t sweep) const;
  bool any(const ScenePoint& place) const;

  // Returns the normal on the side of the first station that samples the place; empty if no station does.
  std::optional<Vec3> facing(const ScenePoint& place) const;

  // Returns the points per square metre that one sweep leaves around the place; 0 if the sweep does not
  // sample it.
  double density(const ScenePoint& place, std::uint32_t sweep) const;

  // Returns the mean distance of the points that all sweeps leave around the place; 0 if none samples it. For
  // a scanner with rings it is the distance of the rings. Grazing rays and rays near the zenith count as less
  // grazing ones, since their points lie close in one direction only.
  double spacing(const ScenePoint& place) const;

 private:
  const Scanner& scanner_;
  double lowest_, highest_;  // sines of the elevation
  std::vector<std::uint32_t> sweeps_;
};

}  // namespace lacuna::synth
