// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/density_steps.hpp"

#include "bench/synth/patch_curves.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lacuna::synth {

namespace {

constexpr double kJump = 2;  // of the spacing

Lattice sampled_by(const Lattice& lattice, std::size_t station, std::size_t stations) {
  Lattice own = lattice;
  for (std::size_t node = 0; node < own.sampled.size(); ++node)
    own.sampled[node] = lattice.by_station[node * stations + station];
  return own;
}

// Returns the pieces of a closed curve in which this holds.
template <typename Holds>
void cut(const Curve& curve, const Holds& holds, std::vector<Curve>& pieces) {
  std::vector<bool> kept;
  for (const CurveNode& place : curve) kept.push_back(holds(place));
  const auto first_gap = static_cast<std::size_t>(std::find(kept.begin(), kept.end(), false) - kept.begin());
  if (first_gap == curve.size()) {
    pieces.push_back(curve);
    pieces.back().push_back(curve.front());
    return;
  }
  Curve piece;
  for (std::size_t i = 1; i <= curve.size(); ++i) {
    const std::size_t at = (first_gap + i) % curve.size();
    if (kept[at]) {
      piece.push_back(curve[at]);
    } else if (!piece.empty()) {
      pieces.push_back(std::exchange(piece, {}));
    }
  }
}

}  // namespace

std::vector<Curve> density_steps(const std::vector<Lattice>& lattices, const Scanner& scanner,
                                 const Visibility& visibility) {
  std::vector<Curve> steps;
  const std::size_t stations = scanner.stations().size();
  for (std::uint32_t station = 0; stations > 1 && station < stations; ++station) {
    const Visibility own = visibility.only(station), others = visibility.without(station);
    for (const Lattice& lattice : lattices) {
      const auto is_step = [&](const CurveNode& at) {
        if (at.at_end) return false;
        const ScenePoint place{at.position, at.normal, at.shape, lattice.patch.two_sided};
        return others.spacing(place) >= kJump * visibility.spacing(place);
      };
      for (const Curve& curve : patch_curves(sampled_by(lattice, station, stations), own))
        cut(curve, is_step, steps);
    }
  }
  return steps;
}

}  // namespace lacuna::synth
