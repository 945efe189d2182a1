// SPDX-License-Identifier: Apache-2.0
// The search in blocks spends most of its time here. It computes distances from one query to the points of
// many blocks, and ranks the nearest of sixteen queries at once. It works on plain arrays, and is compiled
// for each instruction set.
//
// Single precision takes half of the time. Results are exact all the same: distances differ from the true
// ones by less than a margin. An order that the margin could reverse is marked as ambiguous, and left to the
// caller.
#pragma once

#include "engine/simd/batch.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lacuna {

inline constexpr std::size_t kBlock = 16;        // points a block
inline constexpr std::size_t kFan = 8;           // blocks or groups a group
inline constexpr std::size_t kMostBlocks = 128;  // in surroundings

// The boxes of a level of the tree. The first level has the boxes of blocks, and each further level the boxes
// of groups of eight. Levels are padded to whole groups.
struct LevelSides {
  const double *lows[3], *highs[3];
  std::size_t count;
};

// Finds the squared distances between a box and the kFan boxes of a group.
void box_gaps(const double* low, const double* high, const LevelSides& level, std::size_t group,
              double* gaps);

// Sixteen points. Coordinates beyond the last point are infinite.
struct alignas(64) Block {
  double coordinates[3][kBlock];
};

// Blocks around some queries, relative to them: coordinates are (p - origin) * scale in single precision.
struct alignas(64) Surroundings {
  double origin[3];
  double scale;   // a power of two
  double margin;  // squared distances up to the radius differ by less from the true ones
  alignas(64) float low[3][kMostBlocks];  // boxes of the blocks
  float high[3][kMostBlocks];
  struct alignas(64) {
    float coordinates[3][kBlock];
  } near[kMostBlocks];
  std::uint32_t blocks[kMostBlocks];  // their numbers among all
  std::size_t count = 0;
};

// Sets `surroundings.blocks` to all blocks within the radius of a box. Returns false where they are more than
// kMostBlocks. `levels`: `top` is the last one.
bool find_blocks(const LevelSides* levels, std::size_t top, const double* low, const double* high,
                 double squared_radius, Surroundings& surroundings);

// Fills the boxes and coordinates of the blocks. `lows`, `highs`: sides of the boxes of all blocks.
void fill_surroundings(const Block* all, const double* const lows[3], const double* const highs[3],
                       Surroundings& surroundings);

inline constexpr std::size_t kMostCandidates = 128;

// Candidates for a query's neighbours, in any order. The query itself is among them.
struct alignas(64) CandidateList {
  float squared_distances[kMostCandidates + kBlock];
  std::uint32_t points[kMostCandidates + kBlock];
  std::size_t count = 0;          // kMostCandidates + 1: there are more
  float limit;                    // of the squared distances
  float margin;                   // as in `Surroundings`
  double squared_distance_bound;  // set by the caller: all points nearer than this are listed, in true
                                  // distances
};

// Lists all points of the blocks within the limit of the query, which is in the coordinates of the
// surroundings.
void find_within(const Surroundings& surroundings, const float query[3], float limit, CandidateList& list);

// Reduces a list to the candidates within a smaller limit, if at least `least` remain. Else the list stays as
// it is.
void narrow_list(float limit, std::size_t least, CandidateList& list);

inline constexpr std::size_t kQueries = 16;  // ranked side by side

// Candidates of some queries by rank, nearest first. A key is a squared distance whose lowest bits are
// replaced by the candidate's number in its list. So it can be sorted as one number.
struct Ranking {
  Batch<float, kQueries> keys[kMostCandidates];
  std::uint32_t number_bits;
  bool is_ambiguous[kQueries];  // distances of successive ranks are too near for an order

  std::uint32_t number(std::size_t rank, std::size_t query) const {
    return std::bit_cast<std::uint32_t>(keys[rank].at[query]) & number_bits;
  }
  // Returns the points that a list has at ranks 1 to `count`: rank 0 is the query itself.
  void pick(const CandidateList& list, std::size_t query, std::size_t count, std::uint32_t* points) const {
    const std::uint32_t bits = number_bits;
    const float* key = &keys[1].at[query];
    for (std::uint32_t* point = points; point < points + count; ++point, key += kQueries)
      *point = list.points[std::bit_cast<std::uint32_t>(*key) & bits];
  }
};

// Ranks the candidates of at most kQueries lists, as far as they are wanted. Lists of more than
// kMostCandidates count as empty. `ends_at_limit`: points in no list count as if they were at the limit. A
// query is ambiguous if such a point may be nearer than the last wanted one.
void rank_candidates(const CandidateList* lists, std::size_t count, std::size_t wanted, bool ends_at_limit,
                     Ranking& ranking);

}  // namespace lacuna
