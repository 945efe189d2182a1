// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system of a scan: its unit of length, what the user states, and the way to
// longitude and latitude.
#pragma once

#include "io/read/crs/crs_lookup.hpp"
#include "io/read/options/options.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Units of length.

// Returns the unit that has this length in metres: "m", "km", "cm", "mm", "ft" (international foot), "us-ft"
// (US survey foot), "in", "yd". Empty for another length.
std::string unit_of_metres(double metres);
// Returns the length of such a unit in metres; empty for another name.
std::optional<double> metres_of_unit(std::string_view unit);

// What a coordinate reference system is, as PROJ says: of well-known text (OGC 01-009; ISO 19162) or of a
// code. Where GDAL does not understand the text, or without lacuna_gis.so, nothing is known of it.

// Whether the text is "EPSG:25832", "ESRI:102100", or a horizontal and a vertical one, "EPSG:25832+7837".
bool is_code(std::string_view text);
// Whether the code names a zone of UTM, without heights. Such zones are in metres, and need no PROJ.
bool is_utm_code(std::string_view crs);
// Returns the name within well-known text, such as "NAD83 / UTM zone 10N"; a code stays as it is.
std::string name_of_crs(const std::string& crs);
// Looks the system up, once in a run.
const CrsFacts& facts_of(const std::string& crs);
// Returns the unit of x and y. Empty if the system is geographic, or if it has another unit.
std::string length_unit(const std::string& crs);
// Returns the unit of its vertical part likewise; empty if it has none.
std::string vertical_unit(const std::string& crs);
// Returns the horizontal part of a code or of well-known text.
std::string without_vertical(const std::string& crs);

// The coordinate reference system and the unit that the user states, `--crs` and `--unit`.

struct StatedCrs {
  std::string crs;     // well-known text, or a code that is not looked up; empty: not stated
  std::string unit;    // "m" and so on, as stated or of the system; empty if neither is known
  std::string unit_z;  // likewise of z; empty: as the files say, or as x and y
};

// Looks the system up in the database of PROJ. Without lacuna_gis.so it stays as it is, and the log names
// the results that this leaves out. Throws `Error` if there is no such system, or if system and unit
// contradict.
StatedCrs read_stated_crs(const InputConfig& config);

// Returns the scale of a projected system at a place. Returns nothing for other systems, for places that it
// does not have, and without lacuna_gis.so.
std::optional<ProjectionScale> scale_at(const std::string& crs, const Eigen::Vector3d& place);

// Whether two texts name the same system. Different texts are compared by GDAL; without lacuna_gis.so they
// are not the same.
bool is_same_crs(const std::string& a, const std::string& b);

// Longitude and latitude, which RFC 7946 wants in a GeoJSON.

inline constexpr const char* kDegreesCrs = "OGC:CRS84";

// Returns places in longitude and latitude of WGS 84, with z in metres. Places of a geocentric system have
// the height above the ellipsoid. Returns nothing if the system is empty, if lacuna_gis.so is missing,
// or if GDAL has no way that holds for all places. In the last two cases the log has a warning that names
// `file`, and else the warning of warn_of_accuracy.
std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file);

// Warns where the conversion to longitude and latitude moves the datum, with an error of more than a metre.
// The log names `file`, the error, and the grid that PROJ lacks. The place is one of the scan.
void warn_of_accuracy(const std::string& crs, const Eigen::Vector3d& place,
                      const std::filesystem::path& file);

// lacuna_gis.so: the code that needs GDAL, found and loaded where it is wanted.

// Throws `Error` if the module is neither next to the program nor in ../lib/lacuna of its folder. A library
// that holds this code may have it next to it, too, or in lib/lacuna. `user` names what needs it, such as
// "--gpkg". Cheap: loads nothing.
void check_gis_module(const char* user);

// Returns a function of the module, which stays loaded until the program ends. Throws `Error` as above, and
// if the module cannot be loaded.
void* load_gis_function(const char* name, const char* user);

// Returns the same function, or null where the module is missing or cannot be loaded.
void* find_gis_function(const char* name);

}  // namespace lacuna::io
