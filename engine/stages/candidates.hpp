// What the search in blocks does most: distances from one query to the points of many blocks, and the
// nearest of eight queries ranked side by side. Plain arrays, compiled for each instruction set.
#pragma once

#include "engine/core/dispatch.hpp"
#include "engine/core/eight.hpp"
#include "engine/core/sorting_network.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kBlock = 16;        // points a block
inline constexpr std::size_t kFan = 8;           // blocks or groups a group
inline constexpr std::size_t kMostBlocks = 128;  // in sight

// Squared distances between a box and those of a group.
using BoxGaps = void(const double* low, const double* high, const double* const lows[3],
                     const double* const highs[3], double* gaps);
LACUNA_DISPATCH(BoxGaps, box_gaps)

// Those boxes of a group, a bit for each, that are within the radius of a box.
using BoxesWithin = std::uint32_t(const double* low, const double* high, const double* const lows[3],
                                  const double* const highs[3], double squared_radius);
LACUNA_DISPATCH(BoxesWithin, boxes_within)

// Sixteen points; beyond the last one: infinite.
struct alignas(64) Block {
  double coordinates[3][kBlock];
};

// Blocks around some queries.
struct alignas(64) Sight {
  double low[3][kMostBlocks];  // their boxes
  double high[3][kMostBlocks];
  std::uint32_t blocks[kMostBlocks];  // their numbers among all
  std::size_t count = 0;
  const Block* all = nullptr;
};

// Candidates for a query's neighbours. A key is a squared distance whose lowest bits are replaced by the
// point's place, so that it can be sorted as one number; distances whose keys differ in the place only are
// nearer to each other than keys can tell.
inline constexpr std::uint64_t kPlaces = kMostBlocks * kBlock;
static_assert(std::has_single_bit(kPlaces));
inline constexpr std::size_t kMostCandidates = kMostSortedRows;

struct alignas(64) CandidateList {
  double keys[kMostCandidates + kBlock];
  std::uint32_t blocks[kMostBlocks + kFan];  // that may hold some
  std::size_t count;

  // The index of the candidate that has a key.
  std::uint32_t point(double key) const {
    const std::uint64_t place = std::bit_cast<std::uint64_t>(key) % kPlaces;
    return blocks[place / kBlock] * static_cast<std::uint32_t>(kBlock) +
           static_cast<std::uint32_t>(place % kBlock);
  }
};

// All points in sight within the radius of the query, itself among them; the count is kMostCandidates + 1 if
// there are more than that.
using FindWithin = void(const Sight&, const double* query, double squared_radius, CandidateList&);
LACUNA_DISPATCH(FindWithin, find_within)

inline constexpr std::size_t kQueries = kEight;  // ranked side by side

// tied[i]: whether two of the first `wanted` keys of query i, in ascending order, other than infinite ones,
// cannot tell which is nearer.
using FindTies = void(const Eight* rows, std::size_t wanted, bool* tied);
LACUNA_DISPATCH(FindTies, find_ties)

}  // namespace lacuna
