#include "engine/criteria/bundle.hpp"

#include "engine/core/four.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

// Of kFour of the points, from `first` on. What is read again and again is named first: for all that the
// compiler knows, a row that is written might hold it.
void gather_four(const BundledNeighbours& of, std::size_t first, Bundle& bundle) {
  const double* const positions = of.positions;
  const auto position = [=](LocalIndex point) { return positions + std::size_t{3} * point; };
  const std::size_t rows = bundle.rows;
  Eight *const xs = bundle.x, *const ys = bundle.y, *const zs = bundle.z,
               *const squares = bundle.squared_distance;
  const double* points[kFour];
  const LocalIndex* lists[kFour];
  std::size_t counts[kFour], common = rows;
  for (std::size_t i = 0; i < kFour; ++i) {
    points[i] = position(of.points[first + i]);
    lists[i] = of.neighbours[first + i];
    counts[i] = of.counts[first + i];
    common = counts[i] < common ? counts[i] : common;
  }
  const TurnedPositions at = load_turned(points);
  Four sum{};
  const auto store_row = [&](std::size_t row, const double* const(&neighbours)[kFour]) {
    const TurnedPositions q = load_turned(neighbours);
    const Four x = q.x - at.x, y = q.y - at.y, z = q.z - at.z;
    const Four squared = (x * x + y * y) + z * z;
    store(xs[row].at + first, x);
    store(ys[row].at + first, y);
    store(zs[row].at + first, z);
    store(squares[row].at + first, squared);
    sum += root_of_each(squared);
  };
  const double* neighbours[kFour];
  std::size_t row = 0;
  for (; row < common; ++row) {
    for (std::size_t i = 0; i < kFour; ++i) neighbours[i] = position(lists[i][row]);
    store_row(row, neighbours);
  }
  for (; row < rows; ++row) {
    // Beyond the last neighbour the point itself: an offset of 0.
    for (std::size_t i = 0; i < kFour; ++i)
      neighbours[i] = row < counts[i] ? position(lists[i][row]) : points[i];
    store_row(row, neighbours);
  }
  for (std::size_t i = 0; i < kFour; ++i)
    bundle.mean_distance.at[first + i] = sum[i] / static_cast<double>(counts[i]);
}

}  // namespace

void gather_neighbours(const BundledNeighbours& of, Bundle& bundle) {
  for (std::size_t first = 0; first < kBundle; first += kFour) gather_four(of, first, bundle);
}

}  // namespace lacuna::LACUNA_LANES
