#include "engine/bucket/index_file.hpp"

#include "engine/bucket/index_grid.hpp"
#include "engine/run/error.hpp"
#include "engine/store/vdb_transform.hpp"

#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <openvdb/openvdb.h>

namespace lacuna {
namespace {

using Bytes = openvdb::UnknownMetadata::ByteVec;

constexpr const char *kGrid = "cell", *kFinest = "finest", *kShift = "shift", *kOrigin = "origin",
                     *kTiles = "tiles", *kVoxels = "voxels";
// OpenVDB keeps metadata of a type that it does not know as bytes.
constexpr const char* kTileType = "lacuna_tile";

// A tile's record: this, then its cells. All fields have 8 bytes.
struct StoredTile {
  std::uint64_t first_row, raw, points, cells;
};
struct StoredCell {
  double low[3], high[3];
  std::uint64_t first_row, points;
};

std::string tile_name(std::size_t tile) {
  return "tile_" + std::to_string(tile);
}

Bytes record_of(const Tiling& tiling, const Tile& tile) {
  const std::uint64_t count = tile.last_cell - tile.first_cell;
  Bytes bytes(sizeof(StoredTile) + count * sizeof(StoredCell));
  const StoredTile head{value(tile.first_row), tile.raw, tile.points, count};
  std::memcpy(bytes.data(), &head, sizeof head);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Cell& cell = tiling.cells[tile.first_cell + i];
    const Eigen::Vector3d &low = cell.box.min(), &high = cell.box.max();
    const StoredCell stored{
        {low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}, value(cell.first_row), cell.points};
    std::memcpy(bytes.data() + sizeof head + i * sizeof stored, &stored, sizeof stored);
  }
  return bytes;
}

[[noreturn]] void refuse() {
  throw Error("not an index that Lacuna wrote");
}

void add_record(const Bytes& bytes, Tiling& tiling) {
  StoredTile head;
  if (bytes.size() < sizeof head) refuse();
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.cells != (bytes.size() - sizeof head) / sizeof(StoredCell)) refuse();
  const auto first_cell = static_cast<std::uint32_t>(tiling.cells.size());
  for (std::uint64_t i = 0; i < head.cells; ++i) {
    StoredCell stored;
    std::memcpy(&stored, bytes.data() + sizeof head + i * sizeof stored, sizeof stored);
    tiling.cells.push_back(
        {{Eigen::Map<const Eigen::Vector3d>(stored.low), Eigen::Map<const Eigen::Vector3d>(stored.high)},
         Row{stored.first_row},
         stored.points});
  }
  tiling.tiles.push_back({first_cell, static_cast<std::uint32_t>(tiling.cells.size()), Row{head.first_row},
                          head.raw, head.points});
}

Tiling read_tiling(const openvdb::MetaMap& metadata) {
  Tiling tiling;
  const auto tiles = metadata.metaValue<std::int64_t>(kTiles);
  for (std::int64_t t = 0; t < tiles; ++t) {
    const openvdb::Metadata::ConstPtr tile = metadata[tile_name(static_cast<std::size_t>(t))];
    const auto* record = dynamic_cast<const openvdb::UnknownMetadata*>(tile.get());
    if (record == nullptr || record->typeName() != kTileType) refuse();
    add_record(record->value(), tiling);
  }
  tiling.build_tree();
  if (!tiling.check()) refuse();
  return tiling;
}

// OpenVDB reads zeros behind the end of a file that was cut short.
void check_numbers(const openvdb::Int32Grid& grid, const CellGrid& lattice, const Tiling& tiling,
                   const openvdb::MetaMap& metadata) {
  if (static_cast<std::int64_t>(grid.activeVoxelCount()) != metadata.metaValue<std::int64_t>(kVoxels))
    refuse();
  for (auto number = grid.cbeginValueOn(); number; ++number) {
    const openvdb::Coord at = number.getCoord();
    const auto cell = static_cast<std::uint32_t>(*number);
    if (cell >= tiling.cells.size() ||
        lattice.cell_of(tiling.cells[cell].box.min()) != CellCoord{at.x(), at.y(), at.z()})
      refuse();
  }
}

CellGrid read_lattice(const openvdb::MetaMap& metadata) {
  const auto origin = metadata.metaValue<openvdb::Vec3d>(kOrigin);
  return {.finest = metadata.metaValue<std::int32_t>(kFinest),
          .shift = metadata.metaValue<std::int32_t>(kShift),
          .origin = {origin.x(), origin.y(), origin.z()}};
}

}  // namespace

void save_index(const CellIndex& index, const Tiling& tiling, const std::filesystem::path& file) {
  try {
    openvdb::initialize();
    const auto& [cells, grid] = *index.grid_;
    grid->setName(kGrid);
    grid->setTransform(vdb_transform(cells));
    openvdb::MetaMap metadata;
    metadata.insertMeta(kFinest, openvdb::Int32Metadata(cells.finest));
    metadata.insertMeta(kShift, openvdb::Int32Metadata(cells.shift));
    metadata.insertMeta(kOrigin, openvdb::Vec3DMetadata({cells.origin[0], cells.origin[1], cells.origin[2]}));
    metadata.insertMeta(kTiles, openvdb::Int64Metadata(static_cast<std::int64_t>(tiling.tiles.size())));
    metadata.insertMeta(kVoxels, openvdb::Int64Metadata(static_cast<std::int64_t>(grid->activeVoxelCount())));
    for (std::size_t t = 0; t < tiling.tiles.size(); ++t) {
      openvdb::UnknownMetadata record(kTileType);
      record.setValue(record_of(tiling, tiling.tiles[t]));
      metadata.insertMeta(tile_name(t), record);
    }
    openvdb::io::File vdb(file.string());
    vdb.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);  // more would take longer than it saves
    vdb.write(openvdb::GridCPtrVec{grid}, metadata);
  } catch (const std::exception& error) {
    throw Error(file.string() + ": cannot write: " + error.what());
  }
}

StoredIndex read_index(const std::filesystem::path& file) {
  try {
    openvdb::initialize();
    openvdb::io::File vdb(file.string());
    vdb.open(/*delayLoad=*/false);
    const openvdb::MetaMap::Ptr metadata = vdb.getMetadata();
    StoredIndex stored{CellIndex(read_lattice(*metadata)), read_tiling(*metadata)};
    const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(vdb.readGrid(kGrid));
    if (!grid) refuse();
    check_numbers(*grid, stored.index.cells(), stored.tiling, *metadata);
    stored.index.grid_->numbers = grid;
    return stored;
  } catch (const std::exception& error) {
    throw Error(file.string() + ": cannot read: " + error.what());
  }
}

}  // namespace lacuna
