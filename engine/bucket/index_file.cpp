#include "engine/bucket/index_file.hpp"

#include "engine/run/error.hpp"

#include <exception>

#include <openvdb/openvdb.h>

namespace lacuna {

void save_index(const CellGrid& grid, std::span<const IndexedCell> cells, const std::filesystem::path& file) {
  const double edge = grid.edge();
  // OpenVDB refuses voxels of a volume below 3e-15: the index of so small a scan is in units of cells.
  constexpr double kSmallestVoxel = 0x1p-16;
  try {
    openvdb::initialize();
    const auto transform =
        openvdb::math::Transform::createLinearTransform(edge < kSmallestVoxel ? 1.0 : edge);
    const auto points = openvdb::Int32Grid::create(0);
    const auto tiles = openvdb::Int32Grid::create(-1);
    points->setName("points");
    tiles->setName("tile");
    auto points_at = points->getAccessor();
    auto tile_at = tiles->getAccessor();
    for (const IndexedCell& cell : cells) {
      const openvdb::Coord coord(cell.coord[0], cell.coord[1], cell.coord[2]);
      points_at.setValue(coord, cell.points);
      tile_at.setValue(coord, cell.tile);
    }
    points->setTransform(transform);
    tiles->setTransform(transform);
    openvdb::io::File vdb(file.string());
    vdb.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);  // more would take longer than it saves
    vdb.write({points, tiles});
  } catch (const std::exception& error) {
    throw Error(file.string() + ": cannot write: " + error.what());
  }
}

}  // namespace lacuna
