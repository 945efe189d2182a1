#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/criteria/neighbour_batch.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/criteria/neighbour_batch.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/load_pair-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

constexpr std::size_t kStep = kLanes<Doubles>;

// Gathers as many points as a vector holds, from `first` on. What is read again and again is named first: for
// all that the compiler knows, a row that is written might hold it.
void gather_from(const NeighbourLists& lists, std::size_t first, NeighbourBatch& batch) {
  const Doubles d;
  const double* const positions = lists.positions;
  const auto position = [=](LocalIndex point) HWY_ATTR { return positions + std::size_t{3} * point; };
  const std::size_t rows = batch.rows;
  Batch<double>*const xs = batch.x, *const ys = batch.y, *const zs = batch.z,
                      *const squares = batch.squared_distance;
  const double* points[kStep];
  const LocalIndex* neighbours[kStep];
  std::size_t counts[kStep], common = rows;
  for (std::size_t i = 0; i < kStep; ++i) {
    points[i] = position(lists.points[first + i]);
    neighbours[i] = lists.neighbours[first + i];
    counts[i] = lists.counts[first + i];
    common = counts[i] < common ? counts[i] : common;
  }
  const auto at = load_vectors(d, points);
  auto sum = hn::Zero(d);
  const double* row_of[kStep];
  const auto store_row = [&](std::size_t row) HWY_ATTR {
    const auto offset = load_vectors(d, row_of) - at;
    const auto squared = dot(offset, offset);
    hn::Store(offset.x, d, xs[row].at + first);
    hn::Store(offset.y, d, ys[row].at + first);
    hn::Store(offset.z, d, zs[row].at + first);
    hn::Store(squared, d, squares[row].at + first);
    sum = sum + hn::Sqrt(squared);
  };
  std::size_t row = 0;
  for (; row < common; ++row) {
    for (std::size_t i = 0; i < kStep; ++i) row_of[i] = position(neighbours[i][row]);
    store_row(row);
  }
  for (; row < rows; ++row) {
    // Beyond the last neighbour the point itself: an offset of 0.
    for (std::size_t i = 0; i < kStep; ++i)
      row_of[i] = row < counts[i] ? position(neighbours[i][row]) : points[i];
    store_row(row);
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
