// SPDX-License-Identifier: Apache-2.0
// The parameters of a run on files: the engine's parameters, and which files are read and written, and how.
#pragma once

#include "engine/config/config.hpp"
#include "engine/config/config_file.hpp"
#include "engine/export.hpp"
#include "io/read/files/input_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::io {

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
  std::vector<double> leave_out;  // boxes, of min x y z max x y z each; points in them take no part
  bool drop_origin = false;       // without points at 0 0 0 or at the scanner
  bool keep_withheld = false, keep_noise = false;  // of LAS: points that are flagged, or of classes 7 and 18
  std::string where;                               // a condition of attributes; empty: none
  Trust trust = Trust::kNeither;
  std::string crs;  // coordinate reference system: a code, WKT or a file; empty: as the files say
  LengthUnit unit = LengthUnit::kInput;
  LengthUnit unit_z = LengthUnit::kInput;  // of z, where it is another
  bool recursive = false;                  // folders with the folders in them
  bool skip_damaged = false;               // files that cannot be read take no part
};

// How the annotated scan is written: file by file, or as one file.
enum class PointsFormat : std::uint8_t { kInput, kPly, kCsv };

struct OutputConfig {
  PointsFormat points_format = PointsFormat::kInput;
  bool points_normals = false;         // with nx ny nz where they were estimated
  bool gpkg = false, geojson = false;  // for GIS: GeoPackage, GeoJSON
  bool lids = false;                   // triangulated lids of the holes
  bool polygons = false;               // files for GIS have the loops as polygons, too
  double coverage = 0;                 // write coverage.tif with cells of this edge; 0: off
  std::string stations;                // file of where scanners stood; empty: as the scans say
  bool no_coordinates = false;         // loops of holes.json have ids alone
  bool local_coordinates = false;      // PLY: floats relative to an offset
  bool report = false;                 // write report.html
};

// Whether the scan covers an area: a check alone reads these.
struct AreaConfig {
  std::string area, except;  // files of polygons; empty: none
  std::string classes;       // files of polygons, divided by commas
  std::string void_rule;     // as in void_size_of
  double area_tile = 0;      // edge of the squares of the table; 0: no table
  bool is_check = false;     // no parameter; without a file, the scan's outline is the area
};

// The diameter of the least void.
struct VoidSize {
  double length = 0;
  std::string_view unit;      // as "m"; empty: the unit of the scan
  bool is_standards = false;  // by a rule of a standard, which is in metres
};

// A rule is a length, such as "2.8" or "2.8m". Or it is a name with the nominal spacing of points, such as
// "anps:0.7", or with a quality level, "anps:QL2". Names and their sources are in docs/area.md. Throws
// `Error`.
LACUNA_API VoidSize void_size_of(const AreaConfig& area);

struct FilesConfig : Config {
  InputConfig input;
  AreaConfig area;
  OutputConfig output;
};

// The parameters of files alone.
LACUNA_API std::vector<Parameter> file_parameters(FilesConfig& config);
// All parameters, in the order of the config file.
LACUNA_API std::vector<Parameter> parameters(FilesConfig& config);

// Checks what `check_config` of the engine checks, and boxes. Throws, too, where the memory limit is too
// small for a report or for files of GIS.
LACUNA_API void check_config(const FilesConfig& config);

}  // namespace lacuna::io
