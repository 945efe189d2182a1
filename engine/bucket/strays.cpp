// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/strays.hpp"

#include "engine/model/least_first.hpp"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <vector>

namespace lacuna {
namespace {

constexpr std::uint64_t kMostPassedOver = 1024;

// Returns the smallest of `key(point)` after `passed_over` smaller ones. `least(box)` is a lower bound of the
// keys of points in a box.
template <class Least, class Key>
double smallest_after(const TileStore& store, std::uint64_t passed_over, Least&& least, Key&& key) {
  std::priority_queue<double> smallest;  // the largest of them on top
  for_each_cell_least_first(
      store.tiling(), least,
      [&](double to_come) { return smallest.size() > passed_over && to_come >= smallest.top(); },
      [](const CellNode&) { return true; },
      [&](std::uint32_t cell) {
        for (const ScanPoint& point : store.cell(cell)) {
          smallest.push(key(point.position()));
          if (smallest.size() > passed_over + 1) smallest.pop();
        }
      });
  return smallest.top();
}

// Returns the box of the points that are not passed over.
Eigen::AlignedBox3d usual_box(const TileStore& store, std::uint64_t passed_over) {
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = smallest_after(
        store, passed_over, [&](const Eigen::AlignedBox3d& cell) { return cell.min()[axis]; },
        [&](const Eigen::Vector3d& point) { return point[axis]; });
    box.max()[axis] = -smallest_after(
        store, passed_over, [&](const Eigen::AlignedBox3d& cell) { return -cell.max()[axis]; },
        [&](const Eigen::Vector3d& point) { return -point[axis]; });
  }
  return box;
}

}  // namespace

Strays find_strays(const TileStore& store) {
  Strays strays;
  const std::vector<Cell>& cells = store.tiling().cells;
  for (const Cell& cell : cells) strays.rest.extend(cell.box);
  const std::uint64_t points = store.tiling().points();
  if (points < kFewestPoints) return strays;
  const Eigen::AlignedBox3d usual =
      usual_box(store, std::clamp<std::uint64_t>(points / 1024, 1, kMostPassedOver));
  const double grown = kFarFromRest * usual.sizes().maxCoeff();
  if (!(grown > 0)) return strays;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(grown);
  const Eigen::AlignedBox3d near(usual.min() - margin, usual.max() + margin);
  if (near.contains(strays.rest)) return strays;

  strays.rest.setEmpty();
  PointId first{};
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (near.contains(cells[cell].box)) {
      strays.rest.extend(cells[cell].box);
      continue;
    }
    for (const ScanPoint& point : store.cell(cell)) {
      if (near.contains(point.position())) {
        strays.rest.extend(point.position());
        continue;
      }
      strays.has_origin |= point.position().isZero(0);
      if (strays.points++ == 0 || point.id < first) {
        first = point.id;
        strays.example = point.position();
      }
    }
  }
  return strays;
}

}  // namespace lacuna
