// SPDX-License-Identifier: Apache-2.0
#include "engine/results/orient.hpp"

#include "engine/stitch/union_find.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {

OrientationEdge orientation_edge(const OrientedEnd& a, const OrientedEnd& b) {
  const bool a_first = a.id < b.id;
  const OrientedEnd& low = a_first ? a : b;
  const OrientedEnd& high = a_first ? b : a;
  const double cosine = (low.normal.x() * high.normal.x() + low.normal.y() * high.normal.y()) +
                        low.normal.z() * high.normal.z();
  return {.weight = 1 - std::abs(cosine),
          .low_id = low.id,
          .high_id = high.id,
          .low = low.row,
          .high = high.row,
          .opposed = cosine < 0};
}

std::vector<OrientationEdge> spanning_forest(std::vector<OrientationEdge> edges, std::uint64_t first_row,
                                             LocalIndex rows) {
  std::sort(edges.begin(), edges.end());
  std::vector<LocalIndex> parents(rows);
  UnionFind trees(parents);
  const auto local = [&](Row row) { return static_cast<LocalIndex>(value(row) - first_row); };
  std::erase_if(edges, [&](const OrientationEdge& e) { return !trees.unite(local(e.low), local(e.high)); });
  return edges;
}

}  // namespace lacuna
