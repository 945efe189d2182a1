// SPDX-License-Identifier: Apache-2.0
// Stores N_p^k of many points in whole cache lines, since the most frequent query is whether a list holds a
// point.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kListLine = 16;  // neighbours a cache line

struct alignas(64) ListLine {
  std::uint32_t points[kListLine];  // beyond the list: no point
};

// The list of point p: `count` neighbours in the lines from p * stride on.
struct NearestLists {
  const ListLine* lines;
  std::size_t stride;
  std::size_t count;
  std::uint16_t* mutual;  // by line: bit i, its i-th neighbour has the point among its own
};

// Sets `mutual` among points [first, last) and the points before them. Among those points `mutual` is set.
// The lists of points after them need not exist yet.
void find_mutual(const NearestLists& lists, std::uint32_t first, std::uint32_t last);

// Edges from points p to neighbours q. An append writes up to kListLine more.
struct EdgeList {
  std::uint32_t* q;
  std::uint32_t* p;
};

// Sets `edges` to the edges from points [first, last) to neighbours below `owned` that are not mutual.
// `mutual` of all points must be known. Returns how many.
std::size_t find_one_sided(const NearestLists& lists, std::uint32_t first, std::uint32_t last,
                           std::uint32_t owned, const EdgeList& edges);

}  // namespace lacuna
