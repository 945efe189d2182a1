// SPDX-License-Identifier: Apache-2.0
// Boundary edges of the default method: the edges of the weighted tangential Delaunay complex that have one
// consistent triangle. A boundary wedge is a point with two such edges, between which there is no consistent
// triangle around the point. Wedges chain to closed curves. That is done within a fine and a coarse bound on
// the triangles at once, and the better of both curves stands.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/tangential/chains.hpp"
#include "engine/boundary/tangential/star_lists.hpp"
#include "engine/stitch/stitch.hpp"

namespace lacuna::tangential {

class TangentialBoundary final : public BoundaryMethod {
 public:
  TangentialBoundary(const TileStore& store, const Job& job);

  // Finds the stars of the tile's active points, as far as the tile alone can.
  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  void absorb(TileIndex tile, const TileOutput& output) override;
  // Curves of fewer than `min_curve` points are left out: around so few, a sampling leaves wedges anyway.
  FoundLoops find_loops(const Totals& totals, Job& job) override;
  // Those between neighbours on a loop: they lie on the boundary next to the points that the curve passes
  // through.
  RowSet boundary_candidates(const Candidates& candidates, const RowSet&, const RowSet& on_loop,
                             Job& job) const override {
    return candidates.between(on_loop, job);
  }

 private:
  std::vector<Wedge> wedges_of(TileIndex tile);
  void add_loops(std::span<const CurvePoint> curve, Scale scale, Scratch& scratch);
  void chain_tile(TileIndex tile, Stitch<OpenChain>& stitch, std::uint64_t& edges);

  const Tiling& tiling_;
  StarLists stars_;
  Column<CurvePoint> chain_points_;  // of open chains
  RawLoops loops_;
  std::filesystem::path workspace_;
  std::uint64_t curve_budget_;  // bytes for the arrays of a curve, with all threads at work
  const TangentialConfig& config_;
};

}  // namespace lacuna::tangential
