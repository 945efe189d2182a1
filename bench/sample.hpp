// SPDX-License-Identifier: Apache-2.0
// A scan in memory for the kernel benchmarks: a wavy surface with holes, all of it in one tile.
#pragma once

#include "engine/model/neighbourhoods.hpp"
#include "engine/model/points.hpp"

#include <cstdint>

namespace lacuna {

enum class SampleOrder { kScanline, kRandom };

// Returns exactly `points` points on a jittered grid whose lines follow arcs. Their spacing grows by a factor
// of 2, so the density falls by a factor of 4. Every 64 x 64 nodes have a round hole of 4 to 12 spacings.
// Coordinates are 32-bit floats, as in most scans. The same arguments give the same points; the order of the
// batch changes only ids.
PointBatch sample_surface(std::uint32_t points, SampleOrder order);

// Returns the points of a batch as a tile that owns all of them has them: in store order, after survey, split
// and order_tile.
TilePoints sample_tile(const PointBatch& batch);

}  // namespace lacuna
