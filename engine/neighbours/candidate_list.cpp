// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/neighbours/candidate_list.cpp"
// Each target includes what follows foreach_target.h.
// clang-format off
#include "engine/neighbours/candidate_list.hpp"
#include "engine/simd/targets.hpp"
#include <hwy/foreach_target.h>
#include "engine/simd/mask-inl.hpp"
#include "engine/simd/sort-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace {

// As many numbers of a block, or of the queries, as fit. Both have sixteen.
using Singles = hn::CappedTag<float, kBlock>;
using Whole = hn::RebindToUnsigned<Singles>;
static_assert(kBlock == kQueries);
constexpr Singles kSingles;
constexpr Whole kWhole;
constexpr std::size_t kStep = kLanes<Singles>;

constexpr float kLargest = std::numeric_limits<float>::max();

// Finds the squared distances between a box and as many others as a vector holds.
template <class D, class Number>
HWY_INLINE hn::Vec<D> squared_gaps(D d, const Number* low, const Number* high, const Number* const lows[3],
                                   const Number* const highs[3], std::size_t first) {
  auto sum = hn::Zero(d);
  for (int axis = 0; axis < 3; ++axis) {
    const auto below = hn::LoadU(d, lows[axis] + first) - hn::Set(d, high[axis]);
    const auto above = hn::Set(d, low[axis]) - hn::LoadU(d, highs[axis] + first);
    const auto gap = hn::Max(hn::Zero(d), hn::Max(below, above));
    sum = sum + gap * gap;
  }
  return sum;
}

// Collects the blocks of the surroundings whose boxes are within the limit: rounding keeps the order of box
// and points. Returns how many.
HWY_INLINE std::size_t near_blocks(const Surroundings& surroundings, const float* query, float limit,
                                   std::uint32_t* near) {
  const hn::Vec<Singles> all_limit = hn::Set(kSingles, limit);
  const float* const lows[3] = {surroundings.low[0], surroundings.low[1], surroundings.low[2]};
  const float* const highs[3] = {surroundings.high[0], surroundings.high[1], surroundings.high[2]};
  auto numbers = hn::Iota(kWhole, 0);
  std::size_t count = 0;
  for (std::size_t first = 0; first < surroundings.count; first += kStep) {
    const auto within = squared_gaps(kSingles, query, query, lows, highs, first) <= all_limit;
    const auto chosen = hn::And(within, hn::FirstN(kSingles, surroundings.count - first));
    hn::StoreU(compress(numbers, hn::RebindMask(kWhole, chosen)), kWhole, near + count);
    count += hn::CountTrue(kSingles, chosen);
    numbers = numbers + hn::Set(kWhole, static_cast<std::uint32_t>(kStep));
  }
  return count;
}

// Stores those numbers one after the other; returns how many. Whole vectors are written: a store under a mask
// (CompressStore) takes much longer.
HWY_INLINE std::size_t append(hn::Vec<Singles> squared_distances, hn::Vec<Whole> points,
                              hn::Mask<Singles> chosen, CandidateList& list, std::size_t at) {
  hn::StoreU(compress(squared_distances, chosen), kSingles, list.squared_distances + at);
  hn::StoreU(compress(points, hn::RebindMask(kWhole, chosen)), kWhole, list.points + at);
  return hn::CountTrue(kSingles, chosen);
}

// The squared distances of candidates side by side, by their numbers in the lists. Places beyond the last
// candidate hold the largest number there is.
void list_side_by_side(const CandidateList* lists, std::size_t count, std::size_t ranks, Ranking& ranking) {
  for (std::size_t query = 0; query < kQueries; ++query) {
    std::size_t rank = 0;
    if (query < count && lists[query].count <= kMostCandidates) {
      for (; rank < lists[query].count; ++rank)
        ranking.keys[rank].at[query] = lists[query].squared_distances[rank];
    }
    for (; rank < ranks; ++rank) ranking.keys[rank].at[query] = kLargest;
  }
}

HWY_INLINE hn::Vec<Whole> bits_in(hn::Vec<Singles> numbers) {
  return hn::BitCast(kWhole, numbers);
}

void put_numbers(std::size_t ranks, Ranking& ranking) {
  const auto number_bits = hn::Set(kWhole, ranking.number_bits);
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const auto number = hn::Set(kWhole, static_cast<std::uint32_t>(rank));
    for (std::size_t first = 0; first < kQueries; first += kStep) {
      float* const at = ranking.keys[rank].at + first;
      const auto key = hn::Or(hn::AndNot(number_bits, bits_in(hn::Load(kSingles, at))), number);
      hn::Store(hn::BitCast(kSingles, key), kSingles, at);
    }
  }
}

// Finds successive keys that are as near to each other as the numbers in them allow. `ends`: points in no
// list are no nearer.
void find_ambiguous(const float* ends, const float* margins, std::size_t wanted, Ranking& ranking) {
  const auto number_bits = hn::Set(kWhole, ranking.number_bits);
  const auto least_of = [&](hn::Vec<Whole> key)
                            HWY_ATTR { return hn::BitCast(kSingles, hn::AndNot(number_bits, key)); };
  const auto none = least_of(bits_in(hn::Set(kSingles, kLargest)));
  for (std::size_t first = 0; first < kQueries; first += kStep) {
    const auto at = [&](std::size_t rank)
                        HWY_ATTR { return bits_in(hn::Load(kSingles, ranking.keys[rank].at + first)); };
    const auto end = least_of(bits_in(hn::Load(kSingles, ends + first)));
    const auto least_apart = hn::Set(kSingles, 2.0F) * hn::Load(kSingles, margins + first);
    auto ambiguous = hn::FirstN(kSingles, 0);
    for (std::size_t i = 0; i + 1 < wanted; ++i) {
      const auto nearer = hn::BitCast(kSingles, hn::Or(at(i), number_bits));
      const auto farther = hn::Min(least_of(at(i + 1)), end);
      ambiguous = hn::Or(ambiguous, hn::And(farther - nearer <= least_apart, least_of(at(i)) < none));
    }
    const std::uint32_t bits = bits_of(kSingles, ambiguous);
    for (std::size_t i = 0; i < kStep; ++i) ranking.is_ambiguous[first + i] = (bits >> i & 1) != 0;
  }
}

}  // namespace

void box_gaps(const double* low, const double* high, const LevelSides& level, std::size_t group,
              double* gaps) {
  for (std::size_t i = 0; i < kFan; i += kLanes<Doubles>) {
    const auto from = squared_gaps(Doubles(), low, high, level.lows, level.highs, group * kFan + i);
    hn::StoreU(from, Doubles(), gaps + i);
  }
}

bool find_blocks(const LevelSides* levels, std::size_t top, const double* low, const double* high,
                 double squared_radius, Surroundings& surroundings) {
  const auto limit = hn::Set(Doubles(), squared_radius);
  struct BoxGroup {
    std::size_t level, group;
  };
  BoxGroup stack[128];
  std::size_t depth = 0;
  stack[depth++] = {top, 0};
  surroundings.count = 0;
  while (depth > 0) {
    const BoxGroup at = stack[--depth];
    const LevelSides& boxes = levels[at.level];
    const std::size_t first_box = at.group * kFan, left = boxes.count - first_box;
    std::uint32_t within = 0;
    for (std::size_t i = 0; i < kFan; i += kLanes<Doubles>) {
      const auto gaps = squared_gaps(Doubles(), low, high, boxes.lows, boxes.highs, first_box + i);
      within |= bits_of(Doubles(), gaps <= limit) << i;
    }
    if (left < kFan) within &= (1U << left) - 1;  // where distances overflow, so does padding
    for (; within != 0; within &= within - 1) {
      const std::size_t index = first_box + static_cast<std::size_t>(__builtin_ctz(within));
      if (at.level > 0) {
        stack[depth++] = {at.level - 1, index};
        continue;
      }
      if (surroundings.count == kMostBlocks) return false;
      surroundings.blocks[surroundings.count++] = static_cast<std::uint32_t>(index);
    }
  }
  return true;
}

void fill_surroundings(const Block* all, const double* const lows[3], const double* const highs[3],
                       Surroundings& surroundings) {
  const hn::Rebind<float, Doubles> single;
  const auto scale = hn::Set(Doubles(), surroundings.scale);
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = surroundings.origin[axis];
    const auto all_origin = hn::Set(Doubles(), origin);
    for (std::size_t i = 0; i < surroundings.count; ++i) {
      const std::uint32_t number = surroundings.blocks[i];
      surroundings.low[axis][i] = static_cast<float>((lows[axis][number] - origin) * surroundings.scale);
      surroundings.high[axis][i] = static_cast<float>((highs[axis][number] - origin) * surroundings.scale);
      const double* const from = all[number].coordinates[axis];
      float* const to = surroundings.near[i].coordinates[axis];
      for (std::size_t first = 0; first < kBlock; first += kLanes<Doubles>) {
        const auto scaled = (hn::Load(Doubles(), from + first) - all_origin) * scale;
        hn::Store(hn::DemoteTo(single, scaled), single, to + first);
      }
    }
  }
}

void find_within(const Surroundings& surroundings, const float query[3], float limit, CandidateList& list) {
  std::uint32_t near[kMostBlocks + kStep];
  const std::size_t blocks = near_blocks(surroundings, query, limit, near);
  const auto x = hn::Set(kSingles, query[0]), y = hn::Set(kSingles, query[1]),
             z = hn::Set(kSingles, query[2]);
  const auto all_limit = hn::Set(kSingles, limit);
  const auto places = hn::Iota(kWhole, 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks && count <= kMostCandidates; ++i) {
    const auto& block = surroundings.near[near[i]];
    const std::uint32_t first_point = surroundings.blocks[near[i]] * static_cast<std::uint32_t>(kBlock);
    for (std::size_t first = 0; first < kBlock; first += kStep) {
      const auto dx = hn::Load(kSingles, block.coordinates[0] + first) - x;
      const auto dy = hn::Load(kSingles, block.coordinates[1] + first) - y;
      const auto dz = hn::Load(kSingles, block.coordinates[2] + first) - z;
      const auto squared = (dx * dx + dy * dy) + dz * dz;
      const auto points = places + hn::Set(kWhole, first_point + static_cast<std::uint32_t>(first));
      count += append(squared, points, squared <= all_limit, list, count);
    }
  }
  list.count = count <= kMostCandidates ? count : kMostCandidates + 1;
  list.limit = limit;
  list.margin = static_cast<float>(surroundings.margin);
}

void narrow_list(float limit, std::size_t least, CandidateList& list) {
  const auto all_limit = hn::Set(kSingles, limit);
  const auto within = [&](std::size_t first) HWY_ATTR {
    const auto is_within = hn::Load(kSingles, list.squared_distances + first) <= all_limit;
    return hn::And(is_within, hn::FirstN(kSingles, list.count - first));
  };
  std::size_t left = 0;
  for (std::size_t first = 0; first < list.count; first += kStep)
    left += hn::CountTrue(kSingles, within(first));
  if (left < least) return;
  left = 0;
  // It works in place: what is written ends no later than what was read.
  for (std::size_t first = 0; first < list.count; first += kStep) {
    left += append(hn::Load(kSingles, list.squared_distances + first), hn::Load(kWhole, list.points + first),
                   within(first), list, left);
  }
  list.count = left;
  list.limit = limit;
}

void rank_candidates(const CandidateList* lists, std::size_t count, std::size_t wanted, bool ends_at_limit,
                     Ranking& ranking) {
  alignas(64) float ends[kQueries], margins[kQueries];
  std::size_t ranks = wanted;
  for (std::size_t query = 0; query < kQueries; ++query) {
    const CandidateList& list = lists[query < count ? query : 0];
    ends[query] = ends_at_limit && list.count > 0 ? list.limit : kLargest;
    margins[query] = list.margin;
    if (list.count <= kMostCandidates && list.count > ranks) ranks = list.count;
  }
  ranking.number_bits = 1;
  while (ranking.number_bits + 1 < ranks) ranking.number_bits = 2 * ranking.number_bits + 1;
  list_side_by_side(lists, count, ranks, ranking);
  put_numbers(ranks, ranking);
  for (std::size_t first = 0; first < kQueries; first += kStep)
    sort_lanes(kSingles, ranking.keys, ranks, first);
  find_ambiguous(ends, margins, wanted, ranking);
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lacuna {

HWY_EXPORT(box_gaps);
void box_gaps(const double* low, const double* high, const LevelSides& level, std::size_t group,
              double* gaps) {
  HWY_DYNAMIC_DISPATCH(box_gaps)(low, high, level, group, gaps);
}

HWY_EXPORT(find_blocks);
bool find_blocks(const LevelSides* levels, std::size_t top, const double* low, const double* high,
                 double squared_radius, Surroundings& surroundings) {
  return HWY_DYNAMIC_DISPATCH(find_blocks)(levels, top, low, high, squared_radius, surroundings);
}

HWY_EXPORT(fill_surroundings);
void fill_surroundings(const Block* all, const double* const lows[3], const double* const highs[3],
                       Surroundings& surroundings) {
  HWY_DYNAMIC_DISPATCH(fill_surroundings)(all, lows, highs, surroundings);
}

HWY_EXPORT(find_within);
void find_within(const Surroundings& surroundings, const float query[3], float limit, CandidateList& list) {
  HWY_DYNAMIC_DISPATCH(find_within)(surroundings, query, limit, list);
}

HWY_EXPORT(narrow_list);
void narrow_list(float limit, std::size_t least, CandidateList& list) {
  HWY_DYNAMIC_DISPATCH(narrow_list)(limit, least, list);
}

HWY_EXPORT(rank_candidates);
void rank_candidates(const CandidateList* lists, std::size_t count, std::size_t wanted, bool ends_at_limit,
                     Ranking& ranking) {
  HWY_DYNAMIC_DISPATCH(rank_candidates)(lists, count, wanted, ends_at_limit, ranking);
}

}  // namespace lacuna
#endif
