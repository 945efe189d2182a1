// SPDX-License-Identifier: Apache-2.0
// tangential_boundary: boundary edges of the default method (method.md, C).
//
// Idea: the surface is the set of triangles on which neighbouring points agree, each in its own tangent
// plane. These are the locally consistent triangles of the weighted tangential Delaunay complex. Loops are
// where it ends: the edges with one consistent triangle chain to closed curves, whatever the noise. Curves
// are found within a fine and a coarse bound on the triangles at once, and tracking keeps the better of both.
//
// From star to loop: `stars` finds triangles, `active_points` compares them within a tile, `exchange` across
// tiles, and `curves` follows the boundary. This file brings a tile, and then all tiles, through these steps.
//
// Source: Boissonnat, Ghosh, Manifold reconstruction using tangential Delaunay complexes, DCG 2014; the whole
// method: method.md, C. Cost: linear in the active points, but for a sort of the ends of open chains.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/candidates.hpp"
#include "engine/boundary/tangential/active_points.hpp"
#include "engine/boundary/tangential/curves.hpp"
#include "engine/boundary/tangential/exchange.hpp"
#include "engine/config/config.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/stitch/stitch.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::tangential {

// The boundary of a tile, as far as the tile alone knows it.
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

class TangentialBoundary final : public BoundaryMethod {
 public:
  TangentialBoundary(const Tiling& tiling, const TangentialConfig& config, const Spill& spill,
                     const Workers& workers);

  // Finds the stars of the tile's active points, and follows their wedges, as far as the tile alone can.
  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  // Finds the active points that depend on several tiles: with them, all wedges are known.
  void complete_edges(const TileOutputs& outputs) override;
  // Follows the other wedges of each tile to chains, and joins the components of open chains.
  void stitch(const TileOutputs& outputs, const Totals& totals) override;
  // Closes the open chains.
  FoundLoops find_loops(const TileOutputs& outputs) override;
  // Candidates between neighbours on a loop lie on the boundary, next to the points that the curve passes
  // through.
  RowSet boundary_candidates(const TileOutputs& outputs, const RowSet&,
                             const RowSet& on_loop) const override {
    return candidates_between(on_loop, outputs, tiling_, workers_.arena);
  }

 private:
  void add_loops(std::span<const CurveStep> curve, Scale scale, std::span<const CurvePoint> points,
                 Scratch& scratch);
  void add_closed_loops(const TileLoops& closed);
  void stitch_tile(const TileOutputs& outputs, TileIndex tile);

  const Tiling& tiling_;
  const TangentialConfig& config_;
  const Spill& spill_;
  const Workers& workers_;
  std::uint64_t curve_budget_;  // bytes for the arrays of a curve, with all threads at work
  std::optional<BorderExchange> exchange_;
  std::optional<Stitch<OpenChain>> stitch_;
  Column<CurvePoint> chain_points_;  // of open chains
  Loops loops_;
  std::uint64_t edges_ = 0, closed_components_ = 0;
};

}  // namespace lacuna::tangential
