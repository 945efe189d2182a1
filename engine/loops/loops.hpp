// SPDX-License-Identifier: Apache-2.0
// The loops of a level, on disk: a loop may be larger than memory. Memory holds only the place of each loop.
#pragma once

#include "engine/model/loop.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/column.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lacuna {

class Loops {
 public:
  explicit Loops(std::filesystem::path file) : points_(std::move(file)) {}

  // Adds a loop. point(i): point i of `count` points. From any thread.
  void add(std::uint64_t count, const LoopEvidence& evidence,
           const std::function<LoopPoint(std::uint64_t)>& point);
  // Numbers the loops in the order of (first id, length, ids), a fine loop before the same coarse one.
  void sort();

  std::size_t size() const { return index_.size(); }
  std::uint64_t points() const { return points_.size(); }  // of all loops
  std::uint64_t count(std::size_t loop) const { return index_[loop].count; }
  const LoopEvidence& evidence(std::size_t loop) const { return index_[loop].evidence; }
  void set_evidence(std::size_t loop, const LoopEvidence& evidence) { index_[loop].evidence = evidence; }
  // Reads the points of a loop. `to` has the size of the loop.
  void read(std::size_t loop, std::span<LoopPoint> to) const { points_.read(index_[loop].first, to); }
  // Calls visit for the points, in the order of the loop, in blocks.
  void for_each_point(std::size_t loop, const std::function<void(const LoopPoint&)>& visit) const;

  // The loops as streams of a part. `file`: a temporary file.
  void write(PartWriter& part) const;
  static Loops read(const PartReader& part, std::filesystem::path file);

  // Compares the points of two loops by (first id, length, ids). Returns less than 0 where a comes first, and
  // 0 where they have the same points.
  friend int compare_points(const Loops& a, std::size_t i, const Loops& b, std::size_t j);

 private:
  struct Entry {
    std::uint64_t first, count;  // of its points
    PointId first_id;
    LoopEvidence evidence;
  };
  static int compare(const Loops& a, const Entry& i, const Loops& b, const Entry& j);

  Column<LoopPoint> points_;
  std::vector<Entry> index_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

// Loops of several levels, some of which are chosen.
struct ChosenLoops {
  struct LoopOfLevel {
    std::uint32_t level, loop;
  };
  std::vector<Loops> levels;
  std::vector<LoopOfLevel> chosen;  // in the order of (first id, length, ids)

  std::size_t size() const { return chosen.size(); }
  std::uint64_t points() const {
    std::uint64_t points = 0;
    for (std::size_t i = 0; i < size(); ++i) points += count(i);
    return points;
  }
  std::uint64_t count(std::size_t i) const { return levels[chosen[i].level].count(chosen[i].loop); }
  void read(std::size_t i, std::span<LoopPoint> to) const {
    levels[chosen[i].level].read(chosen[i].loop, to);
  }
  void for_each_point(std::size_t i, const std::function<void(const LoopPoint&)>& visit) const {
    levels[chosen[i].level].for_each_point(chosen[i].loop, visit);
  }
};

// Turns a loop so that it begins at its first place, by x, y, z, and goes on to the neighbour that comes
// first. So sums along it do not depend on ids.
void order_by_place(std::span<LoopPoint> loop);

// Calls visit(i, points, scratch) for each loop of `Loops` or `ChosenLoops`, from several threads. Points are
// ordered by place. Memory: three quarters of the working memory, whatever the length of a loop.
template <class LoopSet, class Visit>
void for_each_loop(const LoopSet& loops, const Spill& spill, const Workers& workers, Visit&& visit) {
  std::vector<std::uint64_t> needs;
  const std::uint64_t most = workers.memory.work / (2 * workers.arena.threads());
  for (std::size_t i = 0; i < loops.size(); ++i)
    needs.push_back(std::min<std::uint64_t>(most, 2 * loops.count(i) * sizeof(LoopPoint)));
  workers.for_each_within(workers.memory.work / 4 * 3, needs, [&](std::size_t i) {
    Scratch scratch(spill.folder, most);
    const std::span<LoopPoint> points = scratch.array<LoopPoint>(loops.count(i));
    loops.read(i, points);
    order_by_place(points);
    visit(i, std::span<const LoopPoint>(points), scratch);
  });
}

}  // namespace lacuna
