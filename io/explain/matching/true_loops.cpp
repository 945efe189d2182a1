// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/true_loops.hpp"

#include <algorithm>
#include <numeric>

namespace lacuna::matching {

namespace {

std::array<double, 3> place_of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

void sort_once(std::vector<std::uint64_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

std::vector<std::uint64_t> stand_ins(std::span<const Eigen::Vector3d> positions) {
  std::vector<std::uint64_t> stands_for(positions.size());
  std::iota(stands_for.begin(), stands_for.end(), std::uint64_t{0});
  std::vector<std::uint64_t> order;
  for (std::uint64_t id = 0; id < positions.size(); ++id) {
    if (positions[id].allFinite()) order.push_back(id);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
    return place_of(positions[a]) < place_of(positions[b]);
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place_of(positions[order[i]]) == place_of(positions[order[i - 1]])) {
      stands_for[order[i]] = stands_for[order[i - 1]];
    }
  }
  return stands_for;
}

std::vector<TrueLoop> loops_through(std::span<const LoopIds> ids, std::span<const std::uint64_t> stand_ins) {
  std::vector<TrueLoop> loops;
  for (const LoopIds& line : ids) {
    TrueLoop& loop = loops.emplace_back();
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::uint64_t next = line[i + 1 < line.size() ? i + 1 : 0];
      loop.vertices.push_back(stand_ins[line[i]]);
      loop.edges.push_back({stand_ins[line[i]], stand_ins[next]});
    }
    sort_once(loop.vertices);
  }
  return loops;
}

EdgeTree tree_of_truth(std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions) {
  std::vector<Segment> edges;
  for (std::size_t loop = 0; loop < truth.size(); ++loop) {
    for (const auto& [a, b] : truth[loop].edges) edges.push_back({positions[a], positions[b], loop});
  }
  return EdgeTree(std::move(edges));
}

}  // namespace lacuna::matching
