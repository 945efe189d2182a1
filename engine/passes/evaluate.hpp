// Every point evaluated, and what the global stage needs of the points: a small part of the scan.
#pragma once

#include "engine/data/orientation.hpp"
#include "engine/data/stored_stars.hpp"
#include "engine/passes/job.hpp"
#include "engine/passes/links.hpp"
#include "engine/stages/coherence.hpp"
#include "engine/stages/eligible_edges.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacuna {

// A point that may end up on a loop.
struct StoredVertex {
  LocalIndex owned;
  float probability;
  float surface[3];  // mu_p - p
  StoredPoint point;
};

// A candidate of the coherence step that has gap neighbours.
struct StoredCandidate {
  Candidate candidate;
  StoredPoint point;
  float probability;
};

// An edge out of the tile, to be judged once Pi of its foreign end is known.
struct StoredCrossing {
  Vertex own, foreign;
  Strength strength;  // of its own end
  double distance;
};

// Of one point of the input, for points.ply.
struct StoredResult {
  PointId id;
  Row row;  // of the distinct point
  float probability;
  float criteria[kCriteria];
  float normal[3];
};

// An edge of G between tiles, told by the tile of its lower id.
struct OrientationCrossing {
  LocalIndex owned;
  Row foreign;
  PointId foreign_id;
};

// ---- stars

// A point with neighbours in other tiles, whose star waits for their seats, or one beside such, whose star
// waits to be measured.
struct WaitingPoint {
  LocalIndex place;  // in sight
  std::uint32_t neighbours;
  Standing standing;
  double normal[3];
};

// A point that a waiting one sees.
struct SeenPoint {
  Vertex vertex;
  Sampling sampling;  // none of border points: theirs come later
};

// Stars by tile. Those of a tile are appended in one go or in several, by one thread at a time.
class StarSpill {
 public:
  StarSpill(const Job& job, const std::string& name, std::size_t tiles, std::uint64_t budget);

  void append(TileIndex tile, StoredStars stars);
  StoredStars read(TileIndex tile) const;  // in ascending owned index
  void drop(TileIndex tile);

 private:
  AppendLists<StoredStar> stars_;
  AppendLists<StoredCorner> corners_;
};

__extension__ using Int128 = __int128;

struct Totals {
  std::uint64_t neighbours = 0;  // sum of |N_p|
  std::uint64_t points = 0;      // distinct ones
  std::uint64_t candidates = 0;
  std::uint64_t undefined_normals = 0;
  Int128 edge_length = 0;  // sum over N_p of all p, in units of `length_unit`: exact in any order
  double length_unit = 1;
};

// Lists are by tile, unless said otherwise.

// For the loops of the paper (passes/trace); empty by stars.
struct EdgeLists {
  EdgeLists(const TileStore& store, const Job& job);

  AppendLists<TileEdge> inside;  // eligible ones
  AppendLists<StoredCrossing> crossings;
  Column<Strength> strengths;  // by row, of points with neighbours in other tiles
};

// For loops by stars (passes/rims); empty by the paper.
struct StarLists {
  StarLists(const TileStore& store, const Job& job);

  void drop_waiting(TileIndex tile);  // all but the gaps

  AppendLists<WaitingPoint> waiting;           // in ascending owned index
  AppendLists<LocalIndex> waiting_neighbours;  // of one after the other, in neighbour order: places in sight
  AppendLists<SeenPoint> waiting_sight;        // these points and their neighbours, in ascending row
  std::vector<std::vector<TileIndex>> around;  // tiles with these points, in ascending order
  Column<Seat> seats;                          // by row, of border points and their neighbours
  RowSet rough;
  RowSet unmeasured;           // of waiting points, those whose stars are not measured yet
  StarSpill found;             // stars of waiting points as they are found
  StarSpill open;              // measured stars
  AppendLists<Gap> gaps;       // of settled ones
  AppendLists<Gap> open_gaps;  // of the others (passes/seams)
};

struct EvaluatedScan {
  EvaluatedScan(const TileStore& store, std::uint64_t result_blocks, const Job& job);

  EdgeLists edges;
  StarLists stars;
  AppendLists<StoredVertex> vertices;        // in ascending owned index
  AppendLists<StoredCandidate> candidates;   // in ascending row
  AppendLists<StoredResult> results;         // by block of ids; empty without output.points
  AppendLists<OrientationEdge> orientation;  // each tile's own spanning forest; empty unless asked for
  AppendLists<OrientationCrossing> orientation_crossings;
  Column<StoredNormal> normals;                 // by row; likewise
  std::vector<std::vector<TileIndex>> leaning;  // tiles with candidates whose gap neighbours are in this one
  Totals totals;

  double mean_neighbours() const;   // K
  double mean_edge_length() const;  // over the edges of G
};

// Ids per block of `results`.
inline constexpr std::uint64_t kResultBlock = 1 << 17;

// Consumes the links. `eps`: a length, 0: off. `extent`: the largest distance between points.
EvaluatedScan evaluate_tiles(const TileStore& store, AppendLists<Link> links, std::uint64_t ids, double eps,
                             double extent, Job& job);

}  // namespace lacuna
