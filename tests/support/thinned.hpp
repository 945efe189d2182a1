// SPDX-License-Identifier: Apache-2.0
// The points that represent the cells of a lattice, found plainly.
#pragma once

#include "engine/thin/choose_points.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

using CellKey = std::array<double, 3>;

inline CellKey cell_of(const Eigen::Vector3d& position, double edge) {
  const Eigen::Vector3d cell = Lattice(edge).place_of(position).cell;
  return {cell.x(), cell.y(), cell.z()};
}

// Each occupied cell with the point that represents it.
inline std::map<CellKey, std::size_t> plainly_chosen(const Cloud& cloud, double edge) {
  const auto rank = [&](std::size_t i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    return std::tuple(Lattice(edge).place_of(p).squared_offset, p.x(), p.y(), p.z(), i);
  };
  std::map<CellKey, std::size_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) continue;
    std::size_t& best = chosen.try_emplace(cell_of(cloud.positions[i], edge), i).first->second;
    if (rank(i) < rank(best)) best = i;
  }
  return chosen;
}

// Their ids, ascending.
inline std::vector<std::size_t> plainly_chosen_ids(const Cloud& cloud, double edge) {
  std::vector<std::size_t> ids;
  for (const auto& [cell, id] : plainly_chosen(cloud, edge)) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace lacuna
