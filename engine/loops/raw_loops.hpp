// SPDX-License-Identifier: Apache-2.0
// Loops as they are found, by either method.
#pragma once

#include "engine/model/boundary_graph.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lacuna {

// What a method finds of a loop besides its points (method.md, C.6). The paper's method has no measure of it.
struct LoopEvidence {
  double clearness = 1;     // of its wedges, [0, 1]
  double surface = 1;       // how much the neighbourhoods around it resemble a surface, [0, 1]
  double spacing = 0;       // of the points along it; a length
  double sampling_gap = 0;  // sampling radius over the distance to the neighbours, along it
  bool is_coarse = false;   // found within the coarse bound

  // It may be reported, or be a link of a track. Others are gaps of the sampling.
  bool may_be_hole() const {
    constexpr double kLeastClearness = 0.5, kLeastSurface = 0.3;
    return clearness >= kLeastClearness && surface >= kLeastSurface;
  }
};

// On disk; in memory only where each one is.
class RawLoops {
 public:
  explicit RawLoops(std::filesystem::path file) : vertices_(std::move(file)) {}

  // May be called from any thread. vertex(i): of the i-th of `points` points.
  void add(std::uint64_t points, const LoopEvidence& evidence,
           const std::function<Vertex(std::uint64_t)>& vertex);
  void add(std::span<const Vertex> loop) {
    add(loop.size(), {}, [&](std::uint64_t i) { return loop[i]; });
  }
  std::size_t size() const { return index_.size(); }
  std::uint64_t points() const { return vertices_.size(); }
  std::uint64_t points(std::size_t loop) const { return index_[loop].points; }
  const LoopEvidence& evidence(std::size_t loop) const { return index_[loop].evidence; }
  std::vector<Vertex> read(std::size_t loop) const;
  // In the order of the loop, in blocks: it may be larger than memory.
  void for_each_vertex(std::size_t loop, const std::function<void(const Vertex&)>& visit) const;
  // In order of (first id, length, ids), a fine loop before the same coarse one: from then on loops are
  // numbered in that order.
  void sort();

 private:
  struct Entry {
    std::uint64_t offset, points;
    PointId first;
    LoopEvidence evidence;
  };
  bool comes_first(const Entry& a, const Entry& b) const;

  Column<Vertex> vertices_;
  std::vector<Entry> index_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

}  // namespace lacuna
