// The neighbourhoods of eight points side by side, so that their arithmetic can be compiled for each
// instruction set: plain arrays only.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"
#include "engine/data/ids.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kBundle = kEight;  // points judged together

// Row i holds the i-th neighbour of each point. Beyond a point's count its offsets are 0.
struct Bundle {
  std::size_t rows = 0;  // the largest count
  Eight counts;          // neighbours of each point, from 1 on
  Eight* x = nullptr;    // offsets q - p, by row
  Eight* y = nullptr;
  Eight* z = nullptr;
  Eight* squared_distance = nullptr;
  Eight* weight = nullptr;  // working space
  Eight mean_distance;      // r_p
  Eight given_normals[3];   // unit; NaN: to be estimated
};

// Whose neighbours are gathered. A point may stand there more than once.
struct BundledNeighbours {
  const double* positions;  // x, y, z of all points
  LocalIndex points[kBundle];
  const LocalIndex* neighbours[kBundle];
  std::uint32_t counts[kBundle];
};

// Sets offsets and distances in each of the bundle's rows, and their mean.
using GatherNeighbours = void(const BundledNeighbours&, Bundle&);
LACUNA_DISPATCH(GatherNeighbours, gather_neighbours)

}  // namespace lacuna
