// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/criteria/neighbour_batch.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/criteria/neighbour_batch.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/vector-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

constexpr std::size_t kStep = kLanes<Doubles>;

// Gathers as many points as a vector holds, from `first` on. Values that are read again and again have names
// first. Otherwise the compiler has to assume that an offset that is written changes them.
void gather_from(const NeighbourLists& lists, std::size_t first, NeighbourBatch& batch) {
  const Doubles d;
  const double* const positions = lists.positions;
  const auto position = [=](LocalIndex point) HWY_ATTR { return positions + std::size_t{3} * point; };
  const std::size_t ranks = batch.ranks;
  Batch<double>*const xs = batch.x, *const ys = batch.y, *const zs = batch.z,
                      *const squares = batch.squared_distance;
  const double* points[kStep];
  const LocalIndex* neighbours[kStep];
  std::size_t counts[kStep], common = ranks;
  for (std::size_t i = 0; i < kStep; ++i) {
    points[i] = position(lists.points[first + i]);
    neighbours[i] = lists.neighbours[first + i];
    counts[i] = lists.counts[first + i];
    common = counts[i] < common ? counts[i] : common;
  }
  const auto at = load_vectors(d, points);
  auto sum = hn::Zero(d);
  const double* sources[kStep];
  const auto store_rank = [&](std::size_t rank) HWY_ATTR {
    const auto offset = load_vectors(d, sources) - at;
    const auto squared = dot(offset, offset);
    hn::Store(offset.x, d, xs[rank].at + first);
    hn::Store(offset.y, d, ys[rank].at + first);
    hn::Store(offset.z, d, zs[rank].at + first);
    hn::Store(squared, d, squares[rank].at + first);
    sum = sum + hn::Sqrt(squared);
  };
  std::size_t rank = 0;
  for (; rank < common; ++rank) {
    for (std::size_t i = 0; i < kStep; ++i) sources[i] = position(neighbours[i][rank]);
    store_rank(rank);
  }
  for (; rank < ranks; ++rank) {
    // Ranks beyond the last neighbour get the point itself: an offset of 0.
    for (std::size_t i = 0; i < kStep; ++i)
      sources[i] = rank < counts[i] ? position(neighbours[i][rank]) : points[i];
    store_rank(rank);
  }
  hn::Store(sum / hn::Load(d, batch.counts.at + first), d, batch.mean_distance.at + first);
}

}  // namespace

void gather_neighbours(const NeighbourLists& lists, NeighbourBatch& batch) {
  for (std::size_t i = 0; i < kBatchSize; ++i) batch.counts.at[i] = static_cast<double>(lists.counts[i]);
  for (std::size_t first = 0; first < kBatchSize; first += kStep) gather_from(lists, first, batch);
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(gather_neighbours);
void gather_neighbours(const NeighbourLists& lists, NeighbourBatch& batch) {
  HWY_DYNAMIC_DISPATCH(gather_neighbours)(lists, batch);
}

}  // namespace lacuna
#endif
