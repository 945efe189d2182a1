// SPDX-License-Identifier: Apache-2.0
// Sorts batches of numbers lane by lane, without a branch: the same comparisons whatever the numbers.
#if defined(LACUNA_SIMD_SORT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_SORT_INL
#undef LACUNA_SIMD_SORT_INL
#else
#define LACUNA_SIMD_SORT_INL
#endif

#include "engine/simd/batch.hpp"
#include "engine/simd/sort.hpp"
#include "engine/simd/vector-inl.hpp"

#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// Calls visit(low, high) for the comparisons that bring `batches` batches into ascending order. Each has to
// put the smaller number into batch `low`. Batcher's odd-even merge exchange (Knuth, The Art of Computer
// Programming 3, 5.2.2, algorithm M).
template <class Visit>
constexpr HWY_INLINE void for_each_comparison(std::size_t batches, Visit&& visit) {
  std::size_t top = 1;  // half of the batches, rounded up to a power of two
  while (2 * top < batches) top *= 2;
  for (std::size_t p = top; p > 0; p /= 2) {
    std::size_t q = top, r = 0, d = p;
    for (;;) {
      for (std::size_t i = 0; i + d < batches; ++i) {
        if ((i & p) == r) visit(i, i + d);
      }
      if (q == p) break;
      d = q - p;
      q /= 2;
      r = p;
    }
  }
}

consteval std::size_t count_comparisons(std::size_t batches) {
  std::size_t count = 0;
  for_each_comparison(batches, [&](std::size_t, std::size_t) { ++count; });
  return count;
}

template <std::size_t kBatches>
struct Comparisons {
  struct {
    std::size_t low, high;
  } at[count_comparisons(kBatches)];

  consteval Comparisons() : at{} {
    std::size_t count = 0;
    for_each_comparison(kBatches, [&](std::size_t low, std::size_t high) { at[count++] = {low, high}; });
  }
};

template <class V>
HWY_INLINE void put_in_order(V& low, V& high) {
  const V a = low, b = high;
  low = hn::Min(a, b);
  high = hn::Max(a, b);
}

// Sorts kBatches batches, or one less, of as many lanes as a vector holds. All comparisons are written out,
// so that the batches stay in registers.
template <std::size_t kBatches, class D, class Batch>
void sort_in_registers(D d, Batch* batches, std::size_t count, std::size_t lane) {
  static constexpr Comparisons<kBatches> kAll;
  constexpr std::size_t kLast = kBatches - 1;
  using V = hn::Vec<D>;
  V batch[kBatches];
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    ((batch[i] = hn::Load(d, batches[i].at + lane)), ...);
  }
  (std::make_index_sequence<kLast>{});
  batch[kLast] = count == kBatches ? hn::Load(d, batches[kLast].at + lane)
                                   : all<V>(std::numeric_limits<double>::infinity());
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    (put_in_order(batch[kAll.at[i].low], batch[kAll.at[i].high]), ...);
  }
  (std::make_index_sequence<count_comparisons(kBatches)>{});
  [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR {
    (hn::Store(batch[i], d, batches[i].at + lane), ...);
  }
  (std::make_index_sequence<kLast>{});
  if (count == kBatches) hn::Store(batch[kLast], d, batches[kLast].at + lane);
}

template <class D, class Batch, std::size_t... i>
HWY_INLINE void sort_in_registers(D d, Batch* batches, std::size_t count, std::size_t lane,
                                  std::index_sequence<i...>) {
  using Sort = void(D, Batch*, std::size_t, std::size_t);
  static constexpr Sort* kSorts[] = {sort_in_registers<2 * i + 2, D, Batch>...};
  kSorts[(count - 1) / 2](d, batches, count, lane);
}

template <class D, class Batch>
void sort_in_memory(D d, Batch* batches, std::size_t count, std::size_t lane) {
  for_each_comparison(count, [&](std::size_t i, std::size_t k) HWY_ATTR {
    auto low = hn::Load(d, batches[i].at + lane), high = hn::Load(d, batches[k].at + lane);
    put_in_order(low, high);
    hn::Store(low, d, batches[i].at + lane);
    hn::Store(high, d, batches[k].at + lane);
  });
}

// Sorts as many lanes as a vector holds. Not for NaN.
template <class D, class Batch>
HWY_INLINE void sort_lanes(D d, Batch* batches, std::size_t count, std::size_t lane) {
  if (count < 2) return;
  if (count <= kBatchesInRegisters) {
    sort_in_registers(d, batches, count, lane, std::make_index_sequence<kBatchesInRegisters / 2>{});
  } else {
    sort_in_memory(d, batches, count, lane);
  }
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
