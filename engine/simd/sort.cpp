// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/simd/sort.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/simd/sort.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/sort-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

void sort_batches(Batch<double>* batches, std::size_t count) {
  for (std::size_t i = 0; i < kBatchSize; i += kLanes<Doubles>) sort_lanes(Doubles(), batches, count, i);
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(sort_batches);
void sort_batches(Batch<double>* batches, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(sort_batches)(batches, count);
}

}  // namespace lacuna
#endif
