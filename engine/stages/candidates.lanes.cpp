#include "engine/stages/candidates.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr float kLargest = __FLT_MAX__;

// 0, 1, 2, ...
LACUNA_INLINE SingleBits lane_numbers() {
  SingleBits numbers;
  for (std::size_t i = 0; i < kSingles; ++i) numbers[i] = static_cast<std::uint32_t>(i);
  return numbers;
}

// A bit for each of as many lanes as there are, of a register.
LACUNA_INLINE std::uint32_t lanes_there(std::size_t there) {
  return there < kSingles ? (1U << there) - 1 : ~0U;
}

// Squared distances between a box and as many others as a register holds.
template <class Number>
LACUNA_INLINE auto squared_gaps(const Number* low, const Number* high, const Number* const lows[3],
                                const Number* const highs[3], std::size_t first) {
  decltype(load(low)) sum{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto below = load(lows[axis] + first) - high[axis];
    const auto above = low[axis] - load(highs[axis] + first);
    const auto gap = larger(decltype(sum){}, larger(below, above));
    sum += gap * gap;
  }
  return sum;
}

// Of the blocks in sight, those whose boxes are within the limit: rounding keeps the order of box and points.
// Returns how many.
LACUNA_INLINE std::size_t near_blocks(const Sight& sight, const float* query, float limit,
                                      std::uint32_t* near) {
  std::size_t count = 0;
  const float* const lows[3] = {sight.low[0], sight.low[1], sight.low[2]};
  const float* const highs[3] = {sight.high[0], sight.high[1], sight.high[2]};
  SingleBits numbers = lane_numbers();
  for (std::size_t first = 0; first < sight.count; first += kSingles) {
    const std::uint32_t within = lanes_up_to(squared_gaps(query, query, lows, highs, first), limit);
    const Choice choice(within & lanes_there(sight.count - first));
    choice.pack(near + count, numbers);
    count += choice.count();
    numbers += static_cast<std::uint32_t>(kSingles);
  }
  return count;
}

// The squared distances of candidates side by side, by their numbers in the lists; beyond the last: the
// largest number there is.
void list_side_by_side(const CandidateList* lists, std::size_t count, std::size_t rows, Ranking& ranking) {
  for (std::size_t query = 0; query < kQueries; ++query) {
    std::size_t row = 0;
    if (query < count && lists[query].count <= kMostCandidates) {
      for (; row < lists[query].count; ++row)
        ranking.keys[row].at[query] = lists[query].squared_distances[row];
    }
    for (; row < rows; ++row) ranking.keys[row].at[query] = kLargest;
  }
}

LACUNA_INLINE SingleBits bits_of(Singles numbers) {
  return reinterpret_cast<SingleBits>(numbers);
}

void put_numbers(std::size_t rows, Ranking& ranking) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t first = 0; first < kQueries; first += kSingles) {
      float* const at = ranking.keys[row].at + first;
      const SingleBits key = (bits_of(load(at)) & ~ranking.number_bits) | static_cast<std::uint32_t>(row);
      store(at, reinterpret_cast<Singles>(key));
    }
  }
}

// Of successive keys, as near to each other as the numbers in them allow. `ends`: what is in no list is no
// nearer.
void find_doubts(const float* ends, const float* margins, std::size_t wanted, Ranking& ranking) {
  for (std::size_t first = 0; first < kQueries; first += kSingles) {
    const auto at = [&](std::size_t rank) { return bits_of(load(ranking.keys[rank].at + first)); };
    const auto least_of = [&](SingleBits key) {
      return reinterpret_cast<Singles>(key & ~ranking.number_bits);
    };
    const Singles none = least_of(bits_of(all_lanes(kLargest)));
    const Singles end = least_of(bits_of(load(ends + first)));
    const Singles least_apart = 2 * load(margins + first);
    auto doubts = SingleBits{} != SingleBits{};
    for (std::size_t i = 0; i + 1 < wanted; ++i) {
      const Singles nearer = reinterpret_cast<Singles>(at(i) | ranking.number_bits);
      const Singles farther = smaller(least_of(at(i + 1)), end);
      doubts |= (farther - nearer <= least_apart) & (least_of(at(i)) < none);
    }
    for (std::size_t i = 0; i < kSingles; ++i) ranking.in_doubt[first + i] = doubts[i] != 0;
  }
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
    within |= lanes_up_to(squared_gaps(low, high, lows, highs, first), squared_radius) << first;
  return within;
}

void look_closely(const Block* all, const double* const lows[3], const double* const highs[3], Sight& sight) {
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = sight.origin[axis], scale = sight.scale;
    for (std::size_t i = 0; i < sight.count; ++i) {
      const std::uint32_t number = sight.blocks[i];
      sight.low[axis][i] = single((lows[axis][number] - origin) * scale);
      sight.high[axis][i] = single((highs[axis][number] - origin) * scale);
      const double* const from = all[number].coordinates[axis];
      float* const to = sight.near[i].coordinates[axis];
      for (std::size_t first = 0; first < kBlock; first += kLanes) {
        store(to + first, single((load(from + first) - origin) * scale));
      }
    }
  }
}

void find_within(const Sight& sight, const float query[3], float limit, CandidateList& list) {
  std::uint32_t near[kMostBlocks + kSingles];
  const std::size_t blocks = near_blocks(sight, query, limit, near);
  const Singles x = all_lanes(query[0]), y = all_lanes(query[1]), z = all_lanes(query[2]);
  const SingleBits places = lane_numbers();
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks && count <= kMostCandidates; ++i) {
    const auto& block = sight.near[near[i]];
    const SingleBits points = places + sight.blocks[near[i]] * static_cast<std::uint32_t>(kBlock);
    for (std::size_t first = 0; first < kBlock; first += kSingles) {
      const Singles dx = load(block.coordinates[0] + first) - x;
      const Singles dy = load(block.coordinates[1] + first) - y;
      const Singles dz = load(block.coordinates[2] + first) - z;
      const Singles squared = (dx * dx + dy * dy) + dz * dz;
      const Choice choice(lanes_up_to(squared, limit));
      choice.pack(list.squared_distances + count, squared);
      choice.pack(list.points + count, points + static_cast<std::uint32_t>(first));
      count += choice.count();
    }
  }
  list.count = count <= kMostCandidates ? count : kMostCandidates + 1;
  list.limit = limit;
  list.margin = single(sight.margin);
}

void narrow_list(float limit, std::size_t least, CandidateList& list) {
  const auto within = [&](std::size_t first) {
    return Choice(lanes_up_to(load(list.squared_distances + first), limit) & lanes_there(list.count - first));
  };
  std::size_t left = 0;
  for (std::size_t first = 0; first < list.count; first += kSingles) left += within(first).count();
  if (left < least) return;
  left = 0;
  // In place: what is written ends no later than what was read.
  for (std::size_t first = 0; first < list.count; first += kSingles) {
    const Choice choice = within(first);
    const auto points = load_as<SingleBits>(list.points + first);
    choice.pack(list.squared_distances + left, load(list.squared_distances + first));
    choice.pack(list.points + left, points);
    left += choice.count();
  }
  list.count = left;
  list.limit = limit;
}

void rank_candidates(const CandidateList* lists, std::size_t count, std::size_t wanted, bool ends_at_limit,
                     Ranking& ranking) {
  alignas(64) float ends[kQueries], margins[kQueries];
  std::size_t rows = wanted;
  for (std::size_t query = 0; query < kQueries; ++query) {
    const CandidateList& list = lists[query < count ? query : 0];
    ends[query] = ends_at_limit && list.count > 0 ? list.limit : kLargest;
    margins[query] = list.margin;
    if (list.count <= kMostCandidates && list.count > rows) rows = list.count;
  }
  ranking.number_bits = 1;
  while (ranking.number_bits + 1 < rows) ranking.number_bits = 2 * ranking.number_bits + 1;
  list_side_by_side(lists, count, rows, ranking);
  put_numbers(rows, ranking);
  LACUNA_LANES::sort_single_rows(ranking.keys, rows, wanted);
  find_doubts(ends, margins, wanted, ranking);
}

}  // namespace lacuna::LACUNA_LANES
