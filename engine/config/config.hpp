// SPDX-License-Identifier: Apache-2.0
// What the engine reads of a run's parameters: one struct per stage, defaults here and nowhere else. A stage
// gets its own struct as const. `parameters` lists them all once: the config file, the command line, the
// errors and the printed config come from that list (engine/config/parameter.hpp).
#pragma once

#include "engine/config/parameter.hpp"
#include "engine/criteria/criteria.hpp"
#include "engine/export.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

// Decides how small a hole is still found.
struct ScaleConfig {
  double resolution = 0.0;   // one level, of a lattice with this edge, in units of the scan; 0: all levels
  double min_hole = 0.0;     // diameter of the smallest wanted hole, in units of the scan; 0: off
  bool every_point = false;  // one level, of all points, as with the paper's method
};

struct NeighbourhoodConfig {
  std::int64_t k = 15;        // nearest neighbours before the symmetric closure, >= 1
  double eps = 0.0;           // radius added to the k neighbours, in units of the scan; 0: off
  double eps_fraction = 0.0;  // the same as a fraction of the bounding box's diagonal; at most one is set
};

// Which normals points have: those that they came with, or estimated ones. A point without one has an
// estimated normal.
enum class NormalsUse : std::uint8_t {
  kFitting,    // given ones, unless more than 45 degrees off from the estimated one
  kGiven,      // given ones
  kEstimated,  // estimated ones alone
};

struct NormalsConfig {
  NormalsUse use = NormalsUse::kFitting;
  double crease_threshold = 0.5;  // angle probability above which an estimated normal is turned, [0, 1]
  bool orient = false;            // orient consistently, by minimum spanning tree
};

struct CriteriaConfig {
  double sigma = 1.0;  // sigma / r_p, > 0
  double cone = 15.0;  // degrees around the normal line in which directions are not used, [0, 90)
  std::vector<double> weights = default_weights();  // in the order of the table; >= 0, not all 0
};

struct CoherenceConfig {
  double threshold = 0.5;  // points above it are candidates, [0, 1]
};

struct SpanningConfig {
  double max_prob_weight = 1.1;   // eligible: w_prob below it
  double max_total_weight = 3.0;  // eligible: w_total below it
  std::int64_t e = 0;             // an edge may close a loop of more than e edges; 0: round(2 sqrt(pi K))
};

enum class LoopMethod : std::uint8_t {
  kTangential,  // boundary of the consistent triangles of the tangential Delaunay complex
  kPaper,       // spanning graph and breadth first search (5.1, 5.2)
};
LACUNA_API std::string_view name_of(LoopMethod method);  // as in the config file

struct LoopsConfig {
  LoopMethod method = LoopMethod::kTangential;
};

// The constants of the tangential method, all of them. Lengths are relative, so no constant depends on the
// scan's unit. Here d is the mean distance of a point to its neighbours. M is the median circumradius of the
// triangles around it, and S is their spread (M less the smallest). On a square grid M = 0.41 d and S = 0.
// The constants were chosen on the synthetic and real scans of bench/accuracy. Its README says what happens
// when each is halved and doubled.
struct TangentialConfig {
  // Candidates of a higher probability are seeds. All points along a boundary become active from one seed, so
  // chance gaps below the limit need no stars.
  double seed_probability = 0.7;
  // Largest circumradius: `max_radius` M + S. On a grid 1.41 M closes a missing point, 1.58 M a missing line.
  double max_radius = 1.5;
  // A triangle with a circumradius of more than `hole_radius` d lies in a hole: M and S leave it out. The
  // limit is twice the circumradius on a grid.
  double hole_radius = 0.85;
  // M and S are at most `most_radius` d each, a little more than M on a grid. Where half of the triangles lie
  // in holes, as on strips and islands, medians say nothing.
  double most_radius = 0.5;
  // Curves are found within the bound, and again within `coarse_bound` times the bound. Sparse places next to
  // dense ones are surface within the second bound, too.
  double coarse_bound = 2;
  // A point counts fully for a curve's clearness where the empty circle is this many times as large as the
  // sampling radius. Nine in ten of the circumradii around are no larger than that.
  double clear_radius = 2.5;
  // Clearness adds this many sampling radii to the length of each curve: short curves say little.
  double added_length = 4;
  std::int64_t min_curve = 8;  // points; around fewer, a sampling leaves gaps anyway
};

// Which of the chosen loops are reported. Tracking applies min_confidence, select_loops the others.
struct SelectionConfig {
  double min_confidence = 0.5;  // from 0 to 1; the paper's loops have 1
  double min_perimeter = 0.0;   // lengths in units of the scan
  double min_diameter = 0.0;
  std::int64_t min_points = 0;
  bool holes_only = false;  // no outer boundaries

  friend bool operator==(const SelectionConfig&, const SelectionConfig&) = default;
};

// Which results are wanted besides the loops: in the section `output`, with the OutputConfig of
// io/read/options/.
struct ResultsConfig {
  bool points = false;                   // of every point of the input
  std::int64_t sample_points = 1000000;  // of an even sample of the scan, at most; 0: none
};

struct RunConfig {
  std::int64_t threads = 0;        // 0: one per core
  std::uint64_t memory_limit = 0;  // bytes; 0: half of the machine's memory
  std::int64_t tile_points = 0;    // points per tile at most; 0: chosen from threads and memory limit
  std::string workspace;           // the kept folder, of a run that can go on later; empty: it cannot
  std::string scratch;             // folder for temporary files; empty: in the kept, output or system's
  std::string note;                // no parameter: text of the caller that is kept for it
};

struct Config {
  ScaleConfig scale;
  NeighbourhoodConfig neighbourhood;
  NormalsConfig normals;
  CriteriaConfig criteria;
  CoherenceConfig coherence;
  LoopsConfig loops;
  SpanningConfig spanning;
  TangentialConfig tangential;
  SelectionConfig selection;
  ResultsConfig results;
  RunConfig run;
};

// Every parameter of the engine, in the order of the config file. They point into `config`.
LACUNA_API std::vector<Parameter> parameters(Config& config);

// Cells of the resolution across the smallest wanted hole: of holes of that size, 98 in 100 and more are
// found (docs/method.md, D).
inline constexpr double kCellsAcross = 5;
// Returns the edge of the first level's lattice: the resolution, or what min_hole sets. 0: the first level
// has every point.
LACUNA_API double first_edge(const ScaleConfig& scale);
// The config in effect: min_hole sets min_diameter where that is 0.
template <class AnyConfig>
AnyConfig with_min_hole(AnyConfig config) {
  if (config.selection.min_diameter == 0) config.selection.min_diameter = config.scale.min_hole;
  return config;
}

// Throws `Error` where a value is out of its range, or values contradict each other: eps and eps_fraction,
// all weights 0.
LACUNA_API void check_config(const Config& config);
// Returns the checked config in effect.
Config effective(const Config& config);

}  // namespace lacuna
