// The grid inside of a `CellIndex`. Only for sources that use OpenVDB.
#pragma once

#include "engine/bucket/cell_index.hpp"

#include <openvdb/openvdb.h>

namespace lacuna {

struct CellIndex::Grid {
  CellGrid cells;
  openvdb::Int32Grid::Ptr numbers = openvdb::Int32Grid::create(-1);  // as `kNoCell`
};

}  // namespace lacuna
