// SPDX-License-Identifier: Apache-2.0
#include "tests/support/vdb_grids.hpp"

#include "engine/store/openvdb.hpp"

#include <stdexcept>

namespace lacuna::test {
namespace {

template <class Grid>
void read_values(const Grid& grid, VdbGrid& read) {
  read.background = static_cast<double>(grid.background());
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
    if (!voxel.isVoxelValue()) throw std::runtime_error(grid.getName() + ": a value of many voxels");
    const openvdb::Coord at = voxel.getCoord();
    read.values[{at.x(), at.y(), at.z()}] = static_cast<double>(*voxel);
  }
}

}  // namespace

Eigen::AlignedBox3d VdbGrid::box(const std::array<std::int32_t, 3>& at) const {
  Eigen::AlignedBox3d box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double middle = first_voxel[axis] + at[axis] * voxel;
    box.min()[static_cast<Eigen::Index>(axis)] = middle - voxel / 2;
    box.max()[static_cast<Eigen::Index>(axis)] = middle + voxel / 2;
  }
  return box;
}

std::map<std::string, VdbGrid> read_vdb_grids(const std::filesystem::path& file) {
  openvdb::initialize();
  openvdb::io::File vdb(file.string());
  vdb.open();
  const openvdb::GridPtrVecPtr all = vdb.getGrids();
  std::map<std::string, VdbGrid> grids;
  for (const openvdb::GridBase::Ptr& base : *all) {
    VdbGrid& read = grids[base->getName()];
    read.voxel = base->voxelSize().x();
    const openvdb::Vec3d first = base->indexToWorld(openvdb::Vec3d(0.0));
    read.first_voxel = {first.x(), first.y(), first.z()};
    for (auto meta = base->beginMeta(); meta != base->endMeta(); ++meta)
      read.metadata[meta->first] = meta->second->str();
    if (const auto numbers = openvdb::gridPtrCast<openvdb::Int32Grid>(base)) {
      read_values(*numbers, read);
    } else if (const auto reals = openvdb::gridPtrCast<openvdb::FloatGrid>(base)) {
      read_values(*reals, read);
    } else {
      throw std::runtime_error(base->getName() + ": neither a grid of 32-bit integers nor of floats");
    }
  }
  return grids;
}

}  // namespace lacuna::test
