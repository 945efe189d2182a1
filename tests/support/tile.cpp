// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tile.hpp"

#include "engine/bucket/z_curve.hpp"
#include "tests/support/point_tree.hpp"

#include <cassert>

namespace lacuna {

std::vector<PointId> distinct_ids(const Cloud& cloud) {
  std::map<std::array<double, 3>, PointId> first_at;
  std::vector<PointId> ids;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    if (p.allFinite() && first_at.try_emplace({p.x(), p.y(), p.z()}, PointId{i}).second)
      ids.push_back(PointId{i});
  }
  return ids;
}

namespace {

// As the points of a cell are.
void sort_along_curve(const Cloud& cloud, std::vector<PointId>& ids) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : cloud.positions) box.extend(p);
  const ZCurve curve(box);
  std::vector<std::pair<ZPlace, PointId>> places;
  for (const PointId id : ids) places.emplace_back(curve.place(cloud.positions[value(id)]), id);
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = places[i].second;
}

}  // namespace

TilePoints whole_tile(const Cloud& cloud) {
  return part_tile(cloud, std::vector<bool>(cloud.size(), true), 0);
}

TilePoints part_tile(const Cloud& cloud, const std::vector<bool>& owns, std::size_t k) {
  std::vector<PointId> ids = distinct_ids(cloud);
  sort_along_curve(cloud, ids);
  std::stable_partition(ids.begin(), ids.end(), [&](PointId id) { return owns[value(id)]; });
  TilePoints points;
  for (const PointId id : ids) {
    points.owned += owns[value(id)];
    points.positions.push_back(cloud.positions[value(id)]);
    points.ids.push_back(id);
    points.rows.push_back(Row{value(id)});
  }
  std::vector<std::vector<LocalIndex>> linked(points.owned);
  for (LocalIndex q = points.owned; q < points.size(); ++q) {
    for (const Neighbour& p : nearest_plainly(points.positions, points.ids, q, k))
      if (points.is_owned(p.index)) linked[p.index].push_back(q);
  }
  for (const std::vector<LocalIndex>& row : linked) {
    points.linked.indices.insert(points.linked.indices.end(), row.begin(), row.end());
    points.linked.offsets.push_back(static_cast<std::uint32_t>(points.linked.indices.size()));
  }
  return points;
}

LocalIndex row_of(const TilePoints& points, PointId id) {
  const auto found = std::find(points.ids.begin(), points.ids.end(), id);
  assert(found != points.ids.end());
  return static_cast<LocalIndex>(found - points.ids.begin());
}

std::vector<Eigen::Vector3d> owned_normals(const Cloud& cloud, const TilePoints& points) {
  std::vector<Eigen::Vector3d> normals;
  if (cloud.normals.empty()) return normals;
  for (LocalIndex p = 0; p < points.owned; ++p) normals.push_back(cloud.normals[value(points.ids[p])]);
  return normals;
}

}  // namespace lacuna
