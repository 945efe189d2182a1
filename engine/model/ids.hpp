// SPDX-License-Identifier: Apache-2.0
// The three ways to name a point. They are different types so that they cannot be mixed.
#pragma once

#include <cstdint>
#include <limits>

namespace lacuna {

// Rank of a point in the input: files in the order given, rows in file order. The id decides ties.
enum class PointId : std::uint64_t {};

// Place of a distinct point in the tile store. Rows of a tile are contiguous; not every row is used.
enum class Row : std::uint64_t {};

// Place of a point in the arrays of one tile, or of a vertex in the arrays of one component.
using LocalIndex = std::uint32_t;

inline constexpr LocalIndex kNoIndex = std::numeric_limits<LocalIndex>::max();

constexpr std::uint64_t value(PointId id) {
  return static_cast<std::uint64_t>(id);
}
constexpr std::uint64_t value(Row row) {
  return static_cast<std::uint64_t>(row);
}

}  // namespace lacuna
