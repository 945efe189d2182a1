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

// What a method finds of a loop besides its points. The paper's method has no measure of it.
struct LoopRating {
  double confidence = 1;
  double length = 0;
};

// On disk; in memory only where each one is. Those of less than `min_confidence` are counted, not kept.
class RawLoops {
 public:
  explicit RawLoops(std::filesystem::path file, double min_confidence = 0)
      : min_confidence_(min_confidence), vertices_(std::move(file)) {}

  // May be called from any thread. vertex(i): of the i-th of `points` points.
  void add(std::uint64_t points, const LoopRating& rating,
           const std::function<Vertex(std::uint64_t)>& vertex);
  void add(std::span<const Vertex> loop, const LoopRating& rating) {
    add(loop.size(), rating, [&](std::uint64_t i) { return loop[i]; });
  }
  std::uint64_t found() const { return found_; }
  std::size_t size() const { return index_.size(); }
  std::uint64_t points() const { return vertices_.size(); }
  std::uint64_t points(std::size_t loop) const { return index_[loop].points; }
  const LoopRating& rating(std::size_t loop) const { return index_[loop].rating; }
  std::vector<Vertex> read(std::size_t loop) const;
  // A loop of others, with its rating.
  void add(const RawLoops& others, std::size_t loop);
  // In the order of the loop, in blocks: it may be larger than memory.
  void for_each_vertex(std::size_t loop, const std::function<void(const Vertex&)>& visit) const;
  // In order of (first id, length, ids): from then on `read` and `points` count in that order.
  void sort();

 private:
  struct Entry {
    std::uint64_t offset, points;
    PointId first;
    LoopRating rating;
  };
  bool comes_first(const Entry& a, const Entry& b) const;

  double min_confidence_;
  std::uint64_t found_ = 0;
  Column<Vertex> vertices_;
  std::vector<Entry> index_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

}  // namespace lacuna
