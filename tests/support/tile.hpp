// SPDX-License-Identifier: Apache-2.0
// A cloud as a tile sees it, for tests of single stages.
#pragma once

#include "engine/model/neighbourhoods.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

// The distinct finite points of a cloud, in ascending id; a duplicate's lowest id stands for it.
std::vector<PointId> distinct_ids(const Cloud& cloud);

// A tile that owns all of them, in the order of a Z curve, as in a cell.
TilePoints whole_tile(const Cloud& cloud);

// A tile that owns those that `owns` says, and sees all others as foreign; `linked` for k neighbours.
TilePoints part_tile(const Cloud& cloud, const std::vector<bool>& owns, std::size_t k);

// Where a tile has the point of this id; it must have it.
LocalIndex row_of(const TilePoints& points, PointId id);

// The given normals of its owned points; empty if the cloud has none.
std::vector<Eigen::Vector3d> owned_normals(const Cloud& cloud, const TilePoints& points);

}  // namespace lacuna
