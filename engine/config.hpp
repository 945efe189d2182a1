// SPDX-License-Identifier: Apache-2.0
// Every parameter of a run: one struct per stage. Defaults are here and nowhere else. A stage gets its own
// struct as const. `parameters()` lists them all once. The config file, the command line, the errors and the
// printed config come from that list.
#pragma once

#include "engine/criteria/criteria.hpp"
#include "engine/export.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
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

struct NormalsConfig {
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

struct SelectionConfig {
  double min_confidence = 0.5;  // from 0 to 1; the paper's loops have 1
  double min_perimeter = 0.0;   // lengths in units of the scan
  double max_perimeter = 0.0;   // 0: no limit
  double min_diameter = 0.0;
  std::int64_t min_points = 0;
  bool holes_only = false;  // no outer boundaries
};

// Which returns of a pulse are read.
enum class Returns : std::uint8_t { kAll, kFirst, kLast, kOnly };

// The unit of the lengths of the scan.
enum class LengthUnit : std::uint8_t {
  kInput,  // what the files say
  kM,
  kKm,
  kCm,
  kMm,
  kFt,
  kUsFt,
  kIn,
  kYd
};
LACUNA_API std::string_view name_of(LengthUnit unit);  // as in the config file

struct InputConfig {
  std::string columns;         // names of a text file's columns, space separated; empty: from its header line
  std::vector<double> bounds;  // min x y max x y, or min x y z max x y z; empty: no bounds
  std::vector<double> leave_out;      // boxes, of min x y z max x y z each; points in them take no part
  std::vector<std::int64_t> classes;  // of property classification; empty: all
  Returns returns = Returns::kAll;
  bool drop_origin = false;  // without points at 0 0 0 or at the scanner
  std::string crs;           // coordinate reference system: a code, WKT or a file; empty: as the files say
  LengthUnit unit = LengthUnit::kInput;
};

// How the annotated scan is written: file by file, or as one file.
enum class PointsFormat : std::uint8_t { kInput, kPly, kCsv };

struct OutputConfig {
  bool points = false;  // write the annotated scan: every point of the input with its results
  PointsFormat points_format = PointsFormat::kInput;
  bool normals = false;                  // with nx ny nz where they were estimated
  bool vdb = false;                      // write probability.vdb
  bool obj = false;                      // write the loops for CAD
  bool gpkg = false, geojson = false;    // for GIS: GeoPackage, GeoJSON
  bool shp = false;                      // Shapefile
  bool lids = false;                     // triangulated lids of the holes
  bool polygons = false;                 // files for GIS have the loops as polygons, too
  double coverage = 0;                   // write coverage.tif with cells of this edge; 0: off
  std::string stations;                  // file of where scanners stood; empty: as the scans say
  double cut_outs = 0;                   // write the points within this distance of each hole; 0: off
  bool no_coordinates = false;           // loops of holes.json have ids alone
  bool local_coordinates = false;        // PLY: floats relative to an offset
  std::int64_t sample_points = 1000000;  // of sample.ply, at most; 0: no sample
  bool report = false;                   // write report.html
};

struct RunConfig {
  std::int64_t threads = 0;        // 0: one per core
  std::uint64_t memory_limit = 0;  // bytes; 0: half of the machine's memory
  std::int64_t tile_points = 0;    // points per tile at most; 0: chosen from threads and memory limit
  std::string workspace;           // folder of a run that can go on later; empty: it cannot
  std::string scratch;             // folder for temporary files; empty: in the workspace or the output folder
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
  InputConfig input;
  OutputConfig output;
  RunConfig run;
};

// The conditions under which a parameter changes the results.
struct Need {
  std::string_view options;  // as on the command line; empty: nothing
  bool (*is_given)(const Config&);
};

// A value of an enumeration, by the names of all.
struct NamedValue {
  std::uint8_t* value;
  std::span<const std::string_view> names;
};

// One line of the list: `[section] key = value`, on the command line `--key` with dashes.
struct Parameter {
  using Value = std::variant<std::int64_t*, double*, bool*, std::string*, std::uint64_t*,
                             std::vector<double>*, std::vector<std::int64_t>*, NamedValue>;
  std::string_view section;
  std::string_view key;
  Value value;  // points into the Config it was listed from; uint64_t: a size in bytes
  double min;   // of lists: of each number
  double max;
  std::string_view allowed;  // for error messages: "a whole number from 1 to 1000"
  std::string_view help;
  Need needs;

  LACUNA_API std::string option() const;  // "--tile-points"
  LACUNA_API std::string print() const;   // as in the config file
  // Sets the value from text as on the command line. Throws `Error` naming the key and what is allowed.
  LACUNA_API void set(std::string_view text) const;
};

// Returns every parameter, in the order of the config file.
LACUNA_API std::vector<Parameter> parameters(Config& config);

// Sets the values of the file over the values in `config`. Returns the file's keys. Throws `Error` (file,
// line, key, what is allowed) for unknown keys, wrong types and impossible values.
LACUNA_API std::vector<std::string> read_config(const std::filesystem::path& file, Config& config);

// Does the same with the text of a file.
LACUNA_API std::vector<std::string> read_config_text(const std::string& text,
                                                     const std::filesystem::path& file, Config& config);

// Returns the whole config as TOML, with a help comment above each key.
LACUNA_API std::string print_config(const Config& config);

// Cells of the resolution across the smallest wanted hole. At least 98 in 100 holes of that size are found
// (docs/method.md, D).
inline constexpr double kCellsAcross = 5;
// Returns the edge of the first level's lattice: the resolution, or what min_hole sets. 0: the first level
// has every point.
LACUNA_API double first_edge(const ScaleConfig& scale);
// Returns the config in effect: min_hole sets min_diameter where min_diameter is 0.
LACUNA_API Config with_min_hole(Config config);

// Throws `Error` where values contradict each other (eps and eps_fraction, all weights 0, a memory limit
// too small to work in).
LACUNA_API void check_config(const Config& config);

// "512MiB", "2GiB", "1500000" and back.
LACUNA_API std::optional<std::uint64_t> parse_bytes(std::string_view text);
LACUNA_API std::string print_bytes(std::uint64_t bytes);

}  // namespace lacuna
