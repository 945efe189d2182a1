// SPDX-License-Identifier: Apache-2.0
// Results of every point of the input, for the annotated scan.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace lacuna {

// The beginning of a point's result on disk. Its criteria follow, in the order of the table.
struct ResultHead {
  PointId id;
  Row row;  // of the distinct point
  float probability;
  std::array<float, 3> normal;
};

// Ids per block of results.
inline constexpr std::uint64_t kResultBlock = 1 << 17;

// Emits the results of all points of a tile.
void emit_point_results(const EvaluatedTile& tile, TileOutput& output);

// The results by block of ids. Duplicates have the results of the point that they copy.
class PointResults {
 public:
  // Takes the results of all tiles. `ids`: points of the input.
  PointResults(const TileOutputs& outputs, std::uint64_t ids, const TileStore& store, const Spill& spill,
               const Workers& workers);

  std::size_t blocks() const { return lists_->lists(); }
  // Calls visit(result, criteria), in any order.
  template <class Visit>
  void for_each(std::size_t block, Visit&& visit) const {
    std::vector<float> criteria(criteria_);
    lists_->for_each_block(block, record_bytes() << 14, [&](std::span<const std::byte> bytes) {
      for (std::size_t at = 0; at < bytes.size(); at += record_bytes()) {
        ResultHead result;
        std::memcpy(&result, &bytes[at], sizeof result);
        std::memcpy(criteria.data(), &bytes[at + sizeof result], criteria_ * sizeof(float));
        visit(result, std::span<const float>(criteria));
      }
    });
  }

 private:
  std::size_t record_bytes() const { return sizeof(ResultHead) + criteria_ * sizeof(float); }
  void take(const TileOutputs& outputs, TileIndex tile);
  // Appends the results of the copies of points; clears `copies`. `records`: of all points of the tile,
  // without rows.
  void append(TileIndex tile, std::span<const std::byte> records, std::vector<Duplicate>& copies);

  const TileStore& store_;
  std::size_t criteria_;  // of each point
  std::unique_ptr<AppendBytes> lists_;
};

}  // namespace lacuna
