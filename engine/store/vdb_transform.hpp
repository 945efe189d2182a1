// SPDX-License-Identifier: Apache-2.0
// The places of a grid's voxels in the world. Only for sources that use OpenVDB.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/store/openvdb.hpp"

namespace lacuna {

// OpenVDB refuses voxels with a volume below 3e-15. The coordinates of a grid with such voxels, or with
// volumes that overflow, are in units of its cells.
bool is_in_world_units(const CellGrid& grid);

// Returns the transform under which a voxel is the cell with the same coordinates. OpenVDB takes the middle
// of a voxel as its place.
openvdb::math::Transform::Ptr vdb_transform(const CellGrid& grid);

}  // namespace lacuna
