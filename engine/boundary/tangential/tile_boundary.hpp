// SPDX-License-Identifier: Apache-2.0
// tile_boundary: the boundary of a tile, as far as the tile alone knows it.
#pragma once

#include "engine/boundary/tangential/active_points.hpp"
#include "engine/boundary/tangential/star_streams.hpp"
#include "engine/boundary/tangential/wedge.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/evaluated_tile.hpp"

#include <array>
#include <vector>

namespace lacuna::tangential {

class TileBoundary {
 public:
  // Finds the stars of the tile's active points, and of points that other tiles may make active. Both
  // arguments must outlive this.
  TileBoundary(const EvaluatedTile& tile, const TangentialConfig& config);

  // Emits what other tiles need to know, or may change: active points, open stars and the belt.
  void emit(TileOutput& output);
  // Returns the wedges that no other tile can change, in ascending row.
  std::vector<Wedge> wedges() const;
  CurvePoint curve_point(const Wedge& wedge);
  LoopPoint loop_point(const Wedge& wedge) const;  // without the evidence
  float surface(const Wedge& wedge) const;         // of the evidence

 private:
  using SamplingRadii = std::array<double, kScales.size()>;  // by scale

  const RadiiAround& around(LocalIndex p);
  const SamplingRadii& sampling_radii(LocalIndex p);
  StarRadii radii(LocalIndex p) const { return smallest_radii(found_.stars[p].link, config_); }
  float surface(LocalIndex p) const;
  double length(LocalIndex p, LocalIndex q) const;
  void emit_open_stars(TileOutput& output);
  void emit_belt(TileOutput& output) const;

  const EvaluatedTile& tile_;
  const TangentialConfig& config_;
  TileStars found_;
  RadiiAround around_;
  // Those that were needed so far. Curves pass most of their points several times.
  std::vector<SamplingRadii> sampling_radii_;
  std::vector<LocalIndex> place_;  // by owned point: of its radii; kNoIndex: not needed yet
};

}  // namespace lacuna::tangential
