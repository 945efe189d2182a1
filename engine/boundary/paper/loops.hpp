// SPDX-License-Identifier: Apache-2.0
// loops: closed loops of the spanning graph, and their points (paper, 5.2; method.md, B.3).
//
// Idea: a breadth-first search spreads from a point in both directions along its boundary. The first edge
// that joins two branches of the origin closes the loop through it. Loops consist of vertices alone while
// they are found; one pass over the tiles then brings their points.
//
// Source: the paper, 5.2. Differs from the paper: the paper stops at the first vertex that it reaches again,
// whether or not the loop contains the origin.
// Cost: the vertices within half a loop of each origin. A search that finds no loop costs most: `keep_cycles`
// leaves such origins out beforehand.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/loops/loops.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/column.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace lacuna::paper {

// Calls report(loop) for each loop, in the order in which loops are found. The vertices of a loop start at
// its smallest id and go on to the smaller neighbour of that vertex. A search starts from every vertex that
// is not yet on a loop, in ascending id. Without a loop nothing is reported.
void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report);

// An owned point of a tile that a loop may pass through.
struct TileVertex : LoopPoint {
  LocalIndex owned;
  std::uint32_t padding = 0;  // all bytes are in the checksum of a part
};
inline constexpr RecordStream<TileVertex> kVertices{"vertices"};  // in ascending owned index

// Loops as the search finds them, of vertices alone.
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
