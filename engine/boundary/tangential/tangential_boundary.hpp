// SPDX-License-Identifier: Apache-2.0
// Boundary edges of the default method are the edges of the weighted tangential Delaunay complex that have
// one consistent triangle. A boundary wedge is a point with two such edges, between which there is no
// consistent triangle around the point. Wedges chain to closed curves. Curves are found within a fine and a
// coarse bound on the triangles at once, and the better of both curves is kept.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/candidates.hpp"
#include "engine/boundary/tangential/border_exchange.hpp"
#include "engine/boundary/tangential/chains.hpp"
#include "engine/boundary/tangential/tile_curves.hpp"
#include "engine/stitch/stitch.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace lacuna::tangential {

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
