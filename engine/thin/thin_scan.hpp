// thin: one representative for each occupied cell of a lattice.
#pragma once

#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/thin/occupied_cells.hpp"

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

namespace lacuna {

// A point of the input and the one that represents it: itself, at times.
struct Represented {
  PointId representative;
  PointId id;
};

// Ids of representatives per list of represented points.
inline constexpr std::uint64_t kRepresentedBlock = 1 << 17;

struct ThinnedScan {
  // In an order that depends on the points alone. None once they are in a store.
  std::optional<Column<Representative>> representatives;
  std::uint64_t left = 0;  // representatives
  double edge = 0;         // of the lattice's cells
  bool has_normals = false;
  Eigen::AlignedBox3d bounds;  // of all finite points; empty without any
  std::uint64_t points = 0;    // of the scan
  std::uint64_t dropped = 0;   // with a non-finite coordinate
  // By block of the representative's id: all finite points of the scan. Only with output.points.
  std::optional<AppendLists<Represented>> represented;
};

// Chooses one point for each occupied cell of an absolute lattice (`OccupiedCells` has the rule). The choice
// depends on neither memory, threads nor the order of the points. Reads the scan once. Its points go to parts
// by the hash of their cell, which are thinned one by one. With output.points it says which point represents
// which. Throws `Error`.
ThinnedScan thin_scan(PointSource& scan, double edge, Job& job);
// The same for distinct points that are in a store.
ThinnedScan thin_store(const TileStore& store, double edge, Job& job);

// The representatives as a scan, with the ids of the input. `thinned` must outlive it.
std::unique_ptr<PointSource> read_representatives(const ThinnedScan& thinned);

}  // namespace lacuna
