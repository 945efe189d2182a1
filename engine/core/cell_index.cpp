#include "engine/core/cell_index.hpp"

#include "engine/core/error.hpp"

#include <openvdb/openvdb.h>

namespace lacuna {

struct CellIndex::Grid {
  CellGrid cells;
  openvdb::Int32Grid::Ptr numbers;
};

struct CellIndex::Reader::Access {
  CellGrid cells;
  openvdb::Int32Grid::ConstAccessor numbers;
};

CellIndex::CellIndex(const Tiling& tiling)
    : grid_(std::make_unique<Grid>(Grid{tiling.grid, openvdb::Int32Grid::create(-1)})) {
  openvdb::Int32Grid::Accessor accessor = grid_->numbers->getAccessor();
  for (std::size_t i = 0; i < tiling.cells.size(); ++i) {
    const CellCoord& cell = tiling.cells[i].coord;
    accessor.setValue(openvdb::Coord(cell[0], cell[1], cell[2]), static_cast<std::int32_t>(i));
  }
}

CellIndex::~CellIndex() = default;

CellIndex::Reader::Reader(const CellIndex& index)
    : access_(new Access{index.grid_->cells, index.grid_->numbers->getConstAccessor()}) {}

CellIndex::Reader::~Reader() = default;

std::uint32_t CellIndex::Reader::cell_of(const Eigen::Vector3d& position) {
  const CellCoord cell = access_->cells.cell_of(position);
  const std::int32_t number = access_->numbers.getValue(openvdb::Coord(cell[0], cell[1], cell[2]));
  if (number < 0) throw Error("the input changed while it was read: a point lies where none was counted");
  return static_cast<std::uint32_t>(number);
}

void CellIndex::save(const Tiling& tiling, const std::filesystem::path& file) {
  // OpenVDB refuses voxels of a volume below 3e-15: the index of so small a scan is in units of cells.
  constexpr double kSmallestVoxel = 0x1p-16;
  const double edge = tiling.grid.edge();
  const auto transform = openvdb::math::Transform::createLinearTransform(edge < kSmallestVoxel ? 1.0 : edge);
  const auto points = openvdb::Int32Grid::create(0);
  const auto tiles = openvdb::Int32Grid::create(-1);
  points->setName("points");
  tiles->setName("tile");
  auto points_at = points->getAccessor();
  auto tile_at = tiles->getAccessor();
  for (std::uint32_t i = 0; i < tiling.cells.size(); ++i) {
    const CellCoord& cell = tiling.cells[i].coord;
    const openvdb::Coord coord(cell[0], cell[1], cell[2]);
    points_at.setValue(coord, static_cast<std::int32_t>(tiling.cells[i].points));
    tile_at.setValue(coord, static_cast<std::int32_t>(tiling.tile_of_cell(i)));
  }
  points->setTransform(transform);
  tiles->setTransform(transform);
  try {
    openvdb::io::File(file.string()).write({points, tiles});
  } catch (const openvdb::Exception& error) {
    throw Error(file.string() + ": cannot write: " + error.what());
  }
}

}  // namespace lacuna
