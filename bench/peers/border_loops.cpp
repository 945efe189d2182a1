// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/border_loops.hpp"

#include <map>
#include <set>
#include <utility>

namespace lacuna::peers {
namespace {

using HalfEdge = std::pair<std::size_t, std::size_t>;

// Ends of the half-edges without an opposite one, by their beginnings.
std::map<std::size_t, std::vector<std::size_t>> border_ends(std::span<const Triangle> triangles) {
  std::set<HalfEdge> edges;
  for (const auto& [a, b, c] : triangles) edges.insert({{a, b}, {b, c}, {c, a}});
  std::map<std::size_t, std::vector<std::size_t>> ends;
  for (const auto& [from, to] : edges) {
    if (!edges.contains({to, from})) ends[from].push_back(to);
  }
  return ends;
}

}  // namespace

std::vector<Loop> border_loops(std::span<const Triangle> triangles) {
  std::map<std::size_t, std::vector<std::size_t>> ends = border_ends(triangles);
  std::vector<Loop> loops;
  while (!ends.empty()) {
    Loop chain{ends.begin()->first};
    std::map<std::size_t, std::size_t> place{{chain[0], 0}};  // of each vertex in the chain
    for (auto next = ends.begin(); next != ends.end(); next = ends.find(chain.back())) {
      const std::size_t to = next->second.back();
      next->second.pop_back();
      if (next->second.empty()) ends.erase(next);
      const auto [first, is_new] = place.try_emplace(to, chain.size());
      if (is_new) {
        chain.push_back(to);
        continue;
      }
      const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(first->second);
      loops.emplace_back(begin, chain.end());
      for (const std::size_t id : loops.back()) {
        if (id != to) place.erase(id);
      }
      chain.erase(begin + 1, chain.end());
    }
  }
  return loops;
}

}  // namespace lacuna::peers
