// SPDX-License-Identifier: Apache-2.0
// A slice holds as many points of a batch as a vector holds.
#if defined(LACUNA_CRITERIA_SLICE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_SLICE_INL
#undef LACUNA_CRITERIA_SLICE_INL
#else
#define LACUNA_CRITERIA_SLICE_INL
#endif

#include "engine/criteria/neighbour_batch.hpp"
#include "engine/simd/vector-inl.hpp"

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

using V = hn::Vec<Doubles>;
using Mask = MaskOf<V>;

inline constexpr std::size_t kSlices = kBatchSize / kLanes<Doubles>;

// Point `first` of the batch and the next ones.
struct Slice {
  const NeighbourBatch& batch;
  std::size_t first;

  HWY_INLINE V get(const Batch<double>& numbers) const { return hn::Load(Doubles(), numbers.at + first); }
  HWY_INLINE void set(Batch<double>& numbers, V values) const {
    hn::Store(values, Doubles(), numbers.at + first);
  }

  HWY_INLINE Vector<V> get(const Batch<double> (&numbers)[3]) const {
    return {get(numbers[0]), get(numbers[1]), get(numbers[2])};
  }
  HWY_INLINE void set(Batch<double> (&numbers)[3], Vector<V> values) const {
    set(numbers[0], values.x);
    set(numbers[1], values.y);
    set(numbers[2], values.z);
  }

  HWY_INLINE Vector<V> offset(std::size_t rank) const {
    return {get(batch.x[rank]), get(batch.y[rank]), get(batch.z[rank])};
  }
  // Returns the offset of another neighbour for each point; `ranks` count from 0.
  using Ranks = hn::Rebind<std::int32_t, Doubles>;
  HWY_INLINE Vector<V> offset_at(hn::Vec<Ranks> ranks) const {
    const hn::RebindToSigned<Doubles> wide;
    const auto at =
        hn::ShiftLeft<3>(hn::PromoteTo(wide, ranks)) + hn::Iota(wide, static_cast<std::int64_t>(first));
    static_assert(kBatchSize == 1 << 3);
    return {hn::GatherIndex(Doubles(), batch.x->at, at), hn::GatherIndex(Doubles(), batch.y->at, at),
            hn::GatherIndex(Doubles(), batch.z->at, at)};
  }
};

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
