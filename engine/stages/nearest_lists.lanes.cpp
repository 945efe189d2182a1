#include "engine/stages/nearest_lists.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

LACUNA_INLINE bool holds(const ListLine* lines, std::size_t count, std::uint32_t point) {
#if defined(__AVX512F__)
  static_assert(sizeof(ListLine) == sizeof(__m512i));
  __mmask16 matches{};
  for (const ListLine* line = lines; line < lines + count; ++line)
    matches |= _mm512_cmpeq_epi32_mask(_mm512_load_si512(line), _mm512_set1_epi32(static_cast<int>(point)));
  return matches != 0;
#else
  SingleBits matches{};
  for (const ListLine* line = lines; line < lines + count; ++line) {
    for (std::size_t i = 0; i < kListLine; i += kSingles) {
      SingleBits points;
      __builtin_memcpy(&points, line->points + i, sizeof points);
      matches |= reinterpret_cast<SingleBits>(points == point);
    }
  }
  return any(reinterpret_cast<LaneBits>(matches));
#endif
}

// `stride`: the lists', best known when this is compiled.
LACUNA_INLINE std::size_t find_in(const NearestLists& lists, std::size_t stride, std::uint32_t p,
                                  std::uint32_t owned, OneSidedEdge* edges) {
  const ListLine* own = lists.lines + p * stride;
  std::size_t found = 0;
  for (std::size_t left = lists.count; left > 0; ++own) {
    const std::size_t here = left < kListLine ? left : kListLine;
    for (const std::uint32_t* q = own->points; q < own->points + here; ++q) {
      if (*q >= owned) continue;
      edges[found] = {*q, p};
      found += !holds(lists.lines + *q * stride, stride, p);
    }
    left -= here;
  }
  return found;
}

}  // namespace

std::size_t find_one_sided(const NearestLists& lists, std::uint32_t p, std::uint32_t owned,
                           OneSidedEdge* edges) {
  return lists.stride == 1 ? find_in(lists, 1, p, owned, edges)
                           : find_in(lists, lists.stride, p, owned, edges);
}

}  // namespace lacuna::LACUNA_LANES
