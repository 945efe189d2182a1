// SPDX-License-Identifier: Apache-2.0
// Loops of the spanning graph as the search finds them. They consist of vertices alone.
#pragma once

#include "engine/evaluate/tile_outputs.hpp"
#include "engine/loops/loops.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lacuna::paper {

// An owned point of a tile that a loop may pass through.
struct TileVertex : LoopPoint {
  LocalIndex owned;
  std::uint32_t padding = 0;  // all bytes are in the checksum of a part
};
inline constexpr RecordStream<TileVertex> kVertices{"vertices"};  // in ascending owned index

class RawLoops {
 public:
  explicit RawLoops(std::filesystem::path file) : vertices_(std::move(file)) {}

  void add(std::span<const Vertex> loop);  // from any thread
  std::size_t size() const { return counts_.size(); }

  // Joins each vertex with its point, and sorts the loops. Cost: a pass over the tiles' vertices.
  Loops with_points(const TileOutputs& outputs, const Tiling& tiling, const Spill& spill,
                    const TaskArena& arena) const;

 private:
  Column<Vertex> vertices_;            // loop after loop
  std::vector<std::uint64_t> counts_;  // of each loop's vertices
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

}  // namespace lacuna::paper
