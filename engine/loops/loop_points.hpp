// SPDX-License-Identifier: Apache-2.0
// The points that may lie on a loop, with what measuring a loop needs of them. They are a small part of the
// scan, so measuring loops does not read the tile store again.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/store/append_lists.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

struct StoredVertex {
  LocalIndex owned;
  float probability;
  float surface[3];  // mu_p - p
  StoredPoint point;
};

// By tile, in ascending owned index.
using LoopPointLists = AppendLists<StoredVertex>;

// Puts out the owned points that are wanted.
inline void emit_loop_points(const EvaluatedTile& tile, std::span<const std::uint8_t> is_wanted,
                             TileOutput& output) {
  std::vector<StoredVertex> points;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (!is_wanted[p]) continue;
    const Eigen::Vector3f surface = tile.evaluations[p].mean_offset.cast<float>();
    points.push_back({p, tile.probability(p), {surface.x(), surface.y(), surface.z()}, tile.stored(p)});
  }
  output.add("loop points", std::move(points));
}

inline void absorb_loop_points(TileIndex tile, const TileOutput& output, LoopPointLists& lists) {
  lists.append(tile, output.read<StoredVertex>("loop points"));
}

}  // namespace lacuna
