#include "engine/stages/candidates.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

// Of the blocks in sight, those whose boxes are within the radius: their places. Returns how many.
LACUNA_INLINE std::size_t near_blocks(const Sight& sight, const double* query, double squared_radius,
                                      std::uint32_t* near) {
  double gaps[kMostBlocks];
  for (std::size_t first = 0; first < sight.count; first += kLanes) {
    Lanes sum{};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = load(sight.low[axis] + first) - query[axis];
      const Lanes above = query[axis] - load(sight.high[axis] + first);
      const Lanes gap = larger(larger(below, above), Lanes{});
      sum += gap * gap;
    }
    store(gaps + first, sum);
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < sight.count; ++i) {
    near[count] = static_cast<std::uint32_t>(i);
    count += gaps[i] <= squared_radius;
  }
  return count;
}

LACUNA_INLINE Lanes squared_distances(const Block& block, std::size_t first, const double* query) {
  const Lanes x = load(block.coordinates[0] + first) - query[0];
  const Lanes y = load(block.coordinates[1] + first) - query[1];
  const Lanes z = load(block.coordinates[2] + first) - query[2];
  return (x * x + y * y) + z * z;
}

constexpr std::int64_t kSlotMask = (std::int64_t{1} << kSlotBits) - 1;

// Appends the points of a block within the radius; writes up to a block beyond the count.
#if defined(__AVX512F__)
LACUNA_INLINE void append_within(const Block& block, std::uint32_t first_point, const double* query,
                                 double squared_radius, CandidateList& list, std::size_t& count) {
  const __m512i slots = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i points = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (std::size_t first = 0; first < kBlock; first += kLanes) {
    const Lanes d = squared_distances(block, first, query);
    const __mmask8 near = _mm512_cmp_pd_mask(d, _mm512_set1_pd(squared_radius), _CMP_LE_OQ);
    const __m512i slot = _mm512_add_epi64(slots, _mm512_set1_epi64(static_cast<long long>(count)));
    const __m512i packed = _mm512_maskz_compress_epi64(near, _mm512_castpd_si512(d));
    const __m512i key = _mm512_or_si512(_mm512_andnot_si512(_mm512_set1_epi64(kSlotMask), packed), slot);
    const __m256i point = _mm256_add_epi32(points, _mm256_set1_epi32(static_cast<int>(first_point + first)));
    _mm512_storeu_si512(list.keys + count, key);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(list.points + count),
                        _mm256_maskz_compress_epi32(near, point));
    count += static_cast<std::size_t>(__builtin_popcount(near));
  }
}
#else
LACUNA_INLINE void append_within(const Block& block, std::uint32_t first_point, const double* query,
                                 double squared_radius, CandidateList& list, std::size_t& count) {
  double d[kBlock];
  for (std::size_t first = 0; first < kBlock; first += kLanes)
    store(d + first, squared_distances(block, first, query));
  for (std::size_t i = 0; i < kBlock; ++i) {
    list.keys[count] = from_bits((bits(d[i]) & ~kSlotMask) | static_cast<std::int64_t>(count));
    list.points[count] = first_point + static_cast<std::uint32_t>(i);
    count += d[i] <= squared_radius;
  }
}
#endif

}  // namespace

void box_gaps(const double* low, const double* high, const double* const lows[3],
              const double* const highs[3], double* gaps) {
  for (std::size_t first = 0; first < kFan; first += kLanes) {
    Lanes sum{};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = load(lows[axis] + first) - high[axis];
      const Lanes above = low[axis] - load(highs[axis] + first);
      const Lanes gap = larger(larger(below, above), Lanes{});
      sum += gap * gap;
    }
    store(gaps + first, sum);
  }
}

void find_within(const Sight& sight, const double* query, double squared_radius, CandidateList& list) {
  std::uint32_t near[kMostBlocks + 1];
  const std::size_t blocks = near_blocks(sight, query, squared_radius, near);
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks && count <= kMostCandidates; ++i) {
    const std::uint32_t block = sight.blocks[near[i]];
    append_within(sight.all[block], static_cast<std::uint32_t>(block * kBlock), query, squared_radius, list,
                  count);
  }
  list.count = count <= kMostCandidates ? count : kMostCandidates + 1;
}

void sort_keys(KeyRow* rows, const SortingNetwork& network, std::size_t wanted, bool* tied) {
  for (std::size_t first = 0; first < kQueries; first += kLanes) {
    for (std::size_t i = 0; i < network.count; ++i) {
      const Comparison c = network.comparisons[i];
      const Lanes a = load(rows[c.low].at + first), b = load(rows[c.high].at + first);
      store(rows[c.low].at + first, smaller(a, b));
      store(rows[c.high].at + first, larger(a, b));
    }
    LaneBits ties{};
    for (std::size_t i = 0; i + 1 < wanted; ++i) {
      const LaneBits a = bits(load(rows[i].at + first)), b = bits(load(rows[i + 1].at + first));
      ties |= (a | kSlotMask) == (b | kSlotMask);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) tied[first + lane] = ties[lane] != 0;
  }
}

}  // namespace lacuna::LACUNA_LANES
