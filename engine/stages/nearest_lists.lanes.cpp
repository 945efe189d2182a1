#include "engine/stages/nearest_lists.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

// Points in a register.
using Points = std::uint32_t __attribute__((vector_size(kLaneBytes)));

LACUNA_INLINE bool holds(const ListLine* lines, std::size_t count, std::uint32_t point) {
#if defined(__AVX512F__)
  static_assert(sizeof(ListLine) == sizeof(__m512i));
  __mmask16 matches{};
  for (const ListLine* line = lines; line < lines + count; ++line)
    matches |= _mm512_cmpeq_epi32_mask(_mm512_load_si512(line), _mm512_set1_epi32(static_cast<int>(point)));
  return matches != 0;
#else
  Points matches{};
  for (const ListLine* line = lines; line < lines + count; ++line) {
    for (std::size_t i = 0; i < kListLine; i += kLaneBytes / sizeof(point)) {
      Points points;
      __builtin_memcpy(&points, line->points + i, sizeof points);
      matches |= reinterpret_cast<Points>(points == point);
    }
  }
  return any(reinterpret_cast<LaneBits>(matches));
#endif
}

}  // namespace

std::size_t find_one_sided(const NearestLists& lists, std::uint32_t p, std::uint32_t owned,
                           OneSidedEdge* edges) {
  const ListLine* const own = lists.lines + p * lists.stride;
  std::size_t found = 0;
  for (std::size_t i = 0; i < lists.count; ++i) {
    const std::uint32_t q = own[i / kListLine].points[i % kListLine];
    if (q >= owned) continue;
    edges[found] = {q, p};
    found += !holds(lists.lines + q * lists.stride, lists.stride, p);
  }
  return found;
}

}  // namespace lacuna::LACUNA_LANES
