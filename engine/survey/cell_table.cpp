// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/cell_table.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace lacuna {
namespace {

// The bits in which coordinates differ.
std::uint32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint32_t>(a) ^ static_cast<std::uint32_t>(b);
}

// Multiplied by odd constants, all bits of the coordinates reach the high bits of the product.
std::uint64_t hash_of(const CellCoord& cell) {
  const auto word = [&](std::size_t axis) { return std::uint64_t{static_cast<std::uint32_t>(cell[axis])}; };
  std::uint64_t hash = (word(0) | word(1) << 32) * 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 32 ^ word(2)) * 0xc2b2ae3d27d4eb4f;
  return hash ^ hash >> 32;
}

}  // namespace

bool AlongZCurve::operator()(const CountedCell& a, const CountedCell& b) const {
  std::size_t axis = 0;
  std::uint32_t highest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t differs = difference(a.coord[i], b.coord[i]);
    if (highest < differs && highest < (highest ^ differs)) {  // its highest bit is higher
      axis = i;
      highest = differs;
    }
  }
  return highest != 0 ? a.coord[axis] < b.coord[axis] : a.points < b.points;
}

int doublings_to_join(const CellCoord& a, const CellCoord& b) {
  return static_cast<int>(
      std::bit_width(difference(a[0], b[0]) | difference(a[1], b[1]) | difference(a[2], b[2])));
}

// All slots are located before any of them changes: the cache misses of points in random order overlap.
void CellTable::add(std::span<const CountedCell> runs, int doublings) {
  constexpr std::size_t kTogether = 64;
  std::array<std::size_t, kTogether> slots{};
  for (; !runs.empty(); runs = runs.subspan(std::min(runs.size(), kTogether))) {
    const std::size_t together = std::min(runs.size(), kTogether);
    make_space(size_ + together);
    for (std::size_t i = 0; i < together; ++i) {
      slots[i] = slot_of(lowest_of(runs[i].coord, doublings));
      __builtin_prefetch(&slots_[slots[i]], 1);
    }
    for (std::size_t i = 0; i < together; ++i) {
      const CellCoord cell = lowest_of(runs[i].coord, doublings);
      std::size_t slot = slots[i];
      while (slots_[slot].points > 0 && !same_cell(slots_[slot].coord, cell))
        slot = (slot + 1) & (slots_.size() - 1);
      CountedCell& counted = slots_[slot];
      size_ += counted.points == 0;
      counted.coord = cell;
      counted.points =
          static_cast<std::uint32_t>(std::min(std::uint64_t{counted.points} + runs[i].points, kMostCounted));
    }
  }
}

CellTable CellTable::merged(int doublings) const {
  CellTable merged;
  constexpr std::size_t kTogether = 256;
  std::vector<CountedCell> some;
  for_each([&](const CountedCell& cell) {
    some.push_back(cell);
    if (some.size() < kTogether) return;
    merged.add(some, doublings);
    some.clear();
  });
  merged.add(some, doublings);
  return merged;
}

std::size_t CellTable::slot_of(const CellCoord& cell) const {
  return hash_of(cell) & (slots_.size() - 1);
}

// At most half of the slots are taken.
void CellTable::make_space(std::size_t cells) {
  constexpr std::size_t kFewest = 1024;
  if (2 * cells <= slots_.size()) return;
  std::vector<CountedCell> before(std::bit_ceil(std::max(2 * cells, kFewest)));
  before.swap(slots_);
  for (const CountedCell& run : before) {
    if (run.points == 0) continue;
    std::size_t slot = slot_of(run.coord);
    while (slots_[slot].points > 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = run;
  }
}

}  // namespace lacuna
