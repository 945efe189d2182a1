// N_p^k of many points, in whole cache lines: the question asked most is whether one holds a point.
#pragma once

#include "engine/core/dispatch.hpp"

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
};

// q is among the k nearest of p, but p not among those of q.
struct OneSidedEdge {
  std::uint32_t q, p;
};

// Appends those of the neighbours q of p below `owned` whose lists do not hold p; writes up to `count`.
// Returns how many.
using FindOneSided = std::size_t(const NearestLists&, std::uint32_t p, std::uint32_t owned,
                                 OneSidedEdge* edges);
LACUNA_DISPATCH(FindOneSided, find_one_sided)

}  // namespace lacuna
