#include "tests/support/vdb_grids.hpp"

#include <stdexcept>

#include <openvdb/openvdb.h>

namespace lacuna::test {

std::map<std::string, VdbGrid> read_vdb_grids(const std::filesystem::path& file) {
  openvdb::initialize();
  openvdb::io::File vdb(file.string());
  vdb.open();
  const openvdb::GridPtrVecPtr all = vdb.getGrids();
  std::map<std::string, VdbGrid> grids;
  for (const openvdb::GridBase::Ptr& base : *all) {
    const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(base);
    if (!grid) throw std::runtime_error(base->getName() + ": not a grid of 32-bit integers");
    VdbGrid& read = grids[grid->getName()];
    read.voxel = grid->voxelSize().x();
    read.background = grid->background();
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
      if (!voxel.isVoxelValue()) throw std::runtime_error(grid->getName() + ": a value of many voxels");
      const openvdb::Coord at = voxel.getCoord();
      read.values[{at.x(), at.y(), at.z()}] = *voxel;
    }
  }
  return grids;
}

}  // namespace lacuna::test
