#include "engine/stages/candidates.hpp"

#include "engine/core/lanes.hpp"

namespace lacuna::LACUNA_LANES {
namespace {

constexpr std::int64_t kPlaceBits = kPlaces - 1;

// Squared distances between a box and kLanes others.
LACUNA_INLINE Lanes squared_gaps(const double* low, const double* high, const double* const lows[3],
                                 const double* const highs[3], std::size_t first) {
  Lanes sum{};
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes below = load(lows[axis] + first) - high[axis];
    const Lanes above = low[axis] - load(highs[axis] + first);
    const Lanes gap = larger(larger(below, above), Lanes{});
    sum += gap * gap;
  }
  return sum;
}

// Of the blocks in sight, those whose boxes are within the radius. Returns how many.
LACUNA_INLINE std::size_t near_blocks(const Sight& sight, const double* query, double squared_radius,
                                      std::uint32_t* near) {
  std::size_t count = 0;
  const double* const lows[3] = {sight.low[0], sight.low[1], sight.low[2]};
  const double* const highs[3] = {sight.high[0], sight.high[1], sight.high[2]};
  for (std::size_t first = 0; first < sight.count; first += kLanes) {
    const std::size_t there = sight.count - first;
    const std::uint32_t is_there = there < kLanes ? (1U << there) - 1 : ~0U;
    const std::uint32_t within = lanes_up_to(squared_gaps(query, query, lows, highs, first), squared_radius);
    count += pack(near + count, sight.blocks + first, within & is_there);
  }
  return count;
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

void find_within(const Sight& sight, const double* query, double squared_radius, CandidateList& list) {
  const std::size_t blocks = near_blocks(sight, query, squared_radius, list.blocks);
  const Lanes x = all_lanes(query[0]), y = all_lanes(query[1]), z = all_lanes(query[2]);
  LaneBits places;
  for (std::size_t i = 0; i < kLanes; ++i) places[i] = static_cast<std::int64_t>(i);
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks && count <= kMostCandidates; ++i) {
    const Block& block = sight.all[list.blocks[i]];
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
      const Lanes dx = load(block.coordinates[0] + first) - x;
      const Lanes dy = load(block.coordinates[1] + first) - y;
      const Lanes dz = load(block.coordinates[2] + first) - z;
      const Lanes squared = (dx * dx + dy * dy) + dz * dz;
      const Lanes keys = from_bits((bits(squared) & ~kPlaceBits) | places);
      count += pack(list.keys + count, keys, lanes_up_to(squared, squared_radius));
      places += static_cast<std::int64_t>(kLanes);
    }
  }
  list.count = count <= kMostCandidates ? count : kMostCandidates + 1;
}

void find_ties(const Eight* rows, std::size_t wanted, bool* tied) {
  for (std::size_t first = 0; first < kQueries; first += kLanes) {
    LaneBits ties{};
    for (std::size_t i = 0; i + 1 < wanted; ++i) {
      const LaneBits a = bits(load(rows[i].at + first)), b = bits(load(rows[i + 1].at + first));
      ties |= ((a | kPlaceBits) == (b | kPlaceBits)) & (from_bits(a) < __builtin_inf());
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) tied[first + lane] = ties[lane] != 0;
  }
}

}  // namespace lacuna::LACUNA_LANES
