// thin, over the whole scan: one representative for each cell of the resolution's lattice.
#pragma once

#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

namespace lacuna {

struct Representative {
  StoredPoint point;
  StoredNormal normal;  // only where the scan has normals
};

// A point of the input and the one that represents it: itself, at times.
struct Represented {
  PointId representative;
  PointId id;
};

// Ids of representatives per list of represented points.
inline constexpr std::uint64_t kRepresentedBlock = 1 << 17;

struct ThinnedScan {
  Column<Representative> representatives;  // in ascending id
  double resolution = 0;
  bool has_normals = false;
  Eigen::AlignedBox3d bounds;  // of all finite points; empty without any
  std::uint64_t points = 0;    // input rows
  std::uint64_t dropped = 0;   // with a non-finite coordinate
  // By block of the representative's id: all finite points of the input. Only with output.points.
  std::optional<AppendLists<Represented>> represented;
};

// Chooses one input point for each occupied cell of an absolute lattice with edges of `resolution`: the
// nearest to the mean of the cell's points. Of several it is the one with the lowest coordinates, then the
// lowest id. The choice does not depend on memory, threads or the order of the points. Reads the scan twice,
// and a third time with output.points. Where the cells do not fit in memory, shares of them take as many
// passes each. Throws `Error`.
ThinnedScan thin_scan(PointSource& scan, double resolution, Job& job);

// The representatives as a scan, with the ids of the input. `thinned` must outlive it.
std::unique_ptr<PointSource> read_representatives(const ThinnedScan& thinned);

}  // namespace lacuna
