#include "engine/stages/candidates.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr std::int64_t kPlaceBits = kPlaces - 1;

// Appends the keys of the distances within the radius; writes a whole register.
LACUNA_INLINE void append_within(Lanes squared_distances, Lanes squared_radius, LaneBits places, double* keys,
                                 std::size_t& count) {
  const Lanes all = from_bits((bits(squared_distances) & ~kPlaceBits) | places);
#if defined(__AVX512F__)
  const __mmask8 within = _mm512_cmp_pd_mask(squared_distances, squared_radius, _CMP_LE_OQ);
  _mm512_storeu_pd(keys + count, _mm512_maskz_compress_pd(within, reinterpret_cast<__m512d>(all)));
  count += static_cast<std::size_t>(__builtin_popcount(within));
#else
  for (std::size_t i = 0; i < kLanes; ++i) {
    keys[count] = all[i];
    count += squared_distances[i] <= squared_radius[i];
  }
#endif
}

// Squared distances between a box and kLanes others.
LACUNA_INLINE Lanes squared_gaps(const double* low, const double* high, const double* const lows[3],
                                 const double* const highs[3], std::size_t first) {
  Lanes sum{};
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes below = load(lows[axis] + first) - high[axis];
    const Lanes above = low[axis] - load(highs[axis] + first);
    const Lanes gap = larger(larger(below, above), Lanes{});
    sum += gap * gap;
  }
  return sum;
}

// Appends those of the numbers that are there whose gaps are within the radius; writes kLanes of them.
LACUNA_INLINE void append_near(Lanes gaps, double squared_radius, const std::uint32_t* numbers,
                               std::size_t there, std::uint32_t* near, std::size_t& count) {
#if defined(__AVX512F__)
  const auto is_there = static_cast<__mmask8>(there < kLanes ? (1U << there) - 1 : 0xFFU);
  const __mmask8 within = _mm512_mask_cmp_pd_mask(is_there, gaps, all_lanes(squared_radius), _CMP_LE_OQ);
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(near + count), _mm256_maskz_compress_epi32(within, all));
  count += static_cast<std::size_t>(__builtin_popcount(within));
#else
  for (std::size_t i = 0; i < kLanes && i < there; ++i) {
    near[count] = numbers[i];
    count += gaps[i] <= squared_radius;
  }
#endif
}

// Of the blocks in sight, those whose boxes are within the radius. Returns how many.
LACUNA_INLINE std::size_t near_blocks(const Sight& sight, const double* query, double squared_radius,
                                      std::uint32_t* near) {
  std::size_t count = 0;
  const double* const lows[3] = {sight.low[0], sight.low[1], sight.low[2]};
  const double* const highs[3] = {sight.high[0], sight.high[1], sight.high[2]};
  for (std::size_t first = 0; first < sight.count; first += kLanes) {
    const Lanes gaps = squared_gaps(query, query, lows, highs, first);
    append_near(gaps, squared_radius, sight.blocks + first, sight.count - first, near, count);
  }
  return count;
}

// A bit for each lane.
LACUNA_INLINE std::uint32_t bits_within(Lanes squared, double squared_radius) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(squared, all_lanes(squared_radius), _CMP_LE_OQ);
#else
  std::uint32_t within = 0;
  for (std::size_t i = 0; i < kLanes; ++i)
    within |= static_cast<std::uint32_t>(squared[i] <= squared_radius) << i;
  return within;
#endif
}

}  // namespace

void box_gaps(const double* low, const double* high, const double* const lows[3],
              const double* const highs[3], double* gaps) {
  for (std::size_t first = 0; first < kFan; first += kLanes)
    store(gaps + first, squared_gaps(low, high, lows, highs, first));
}

std::uint32_t boxes_within(const double* low, const double* high, const double* const lows[3],
                           const double* const highs[3], double squared_radius) {
  std::uint32_t within = 0;
  for (std::size_t first = 0; first < kFan; first += kLanes)
    within |= bits_within(squared_gaps(low, high, lows, highs, first), squared_radius) << first;
  return within;
}

void find_within(const Sight& sight, const double* query, double squared_radius, CandidateList& list) {
  const std::size_t blocks = near_blocks(sight, query, squared_radius, list.blocks);
  const Lanes x = all_lanes(query[0]), y = all_lanes(query[1]), z = all_lanes(query[2]);
  const Lanes radius = all_lanes(squared_radius);
  LaneBits places;
  for (std::size_t i = 0; i < kLanes; ++i) places[i] = static_cast<std::int64_t>(i);
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks && count <= kMostCandidates; ++i) {
    const Block& block = sight.all[list.blocks[i]];
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
      const Lanes dx = load(block.coordinates[0] + first) - x;
      const Lanes dy = load(block.coordinates[1] + first) - y;
      const Lanes dz = load(block.coordinates[2] + first) - z;
      append_within((dx * dx + dy * dy) + dz * dz, radius, places, list.keys, count);
      places += static_cast<std::int64_t>(kLanes);
    }
  }
  list.count = count <= kMostCandidates ? count : kMostCandidates + 1;
}

void find_ties(const Eight* rows, std::size_t wanted, bool* tied) {
  for (std::size_t first = 0; first < kQueries; first += kLanes) {
    LaneBits ties{};
    for (std::size_t i = 0; i + 1 < wanted; ++i) {
      const LaneBits a = bits(load(rows[i].at + first)), b = bits(load(rows[i + 1].at + first));
      ties |= ((a | kPlaceBits) == (b | kPlaceBits)) & (from_bits(a) < __builtin_inf());
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) tied[first + lane] = ties[lane] != 0;
  }
}

}  // namespace lacuna::LACUNA_LANES
