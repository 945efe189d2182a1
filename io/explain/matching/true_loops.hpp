// SPDX-License-Identifier: Apache-2.0
// The truth about a scan: the loops of its holes and outer edges.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/matching/edge_tree.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::matching {

using LoopIds = std::vector<std::uint64_t>;  // closed, in the order of its edges, at least one id

// A place may have several points; ids here are the ids of the points that stand for a place (see stand_ins).
struct TrueLoop {
  std::vector<std::uint64_t> vertices;              // ascending, each once
  std::vector<std::array<std::uint64_t, 2>> edges;  // in its order and direction
  std::string name;                                 // its name in the truth; empty if it has none
  std::optional<LoopKind> kind;                     // of loops as text; of a mesh's boundary not known
  bool is_narrow = false;                           // too narrow to count, whatever its length
};

// Returns for each point the lowest id among the points at exactly its coordinates (-0 is 0). A point that is
// not finite gets its own id.
std::vector<std::uint64_t> stand_ins(std::span<const Eigen::Vector3d> positions);

// Sorts ids, and leaves out those that are repeated.
void sort_once(std::vector<std::uint64_t>& ids);

// Returns the closed polygons through `ids`, in their order.
std::vector<TrueLoop> loops_through(std::span<const LoopIds> ids, std::span<const std::uint64_t> stand_ins);

// Holds all edges of the loops; their owners are places in `truth`.
EdgeTree tree_of_truth(std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions);

}  // namespace lacuna::matching
