// SPDX-License-Identifier: Apache-2.0
#include "io/read/options/options.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <span>
#include <utility>

namespace lacuna::io {
namespace {

// In the order of their enumerations.
constexpr std::string_view kTrust[] = {"neither", "header", "file"};
constexpr std::string_view kUnitNames[] = {"input", "m", "km", "cm", "mm", "ft", "us-ft", "in", "yd"};
constexpr std::string_view kPointsFormats[] = {"input", "ply", "csv"};

bool has_loops_for_gis(const OutputConfig& output) {
  return output.gpkg || output.geojson;
}

// Min along each axis, then max along each.
void check_box(const std::string& name, std::span<const double> box) {
  const std::size_t axes = box.size() / 2;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (box[axis] > box[axes + axis])
      throw Error(name + " are empty: min " + std::string(1, "xyz"[axis]) + " = " + print_number(box[axis]) +
                  " is above max " + "xyz"[axis] + " = " + print_number(box[axes + axis]) +
                  "; all of min come before all of max");
  }
}

void check_boxes(const InputConfig& input) {
  const std::vector<double>& bounds = input.bounds;
  if (!bounds.empty() && bounds.size() != 4 && bounds.size() != 6)
    throw Error("bounds has " + std::to_string(bounds.size()) +
                (bounds.size() == 1 ? " number" : " numbers") +
                "; allowed: 4 (min x y, max x y) or 6 (min x y z, max x y z), divided by commas");
  check_box("bounds", bounds);
  const std::span<const double> boxes = input.leave_out;
  if (boxes.size() % 6 != 0)
    throw Error("leave_out has " + std::to_string(boxes.size()) +
                " numbers; allowed: 6 for each box (min x y z, max x y z), divided by commas");
  for (std::size_t at = 0; at < boxes.size(); at += 6) check_box("boxes of leave_out", boxes.subspan(at, 6));
}

// A report is put together in memory, and GDAL has memory of its own. Measured beyond the rest: 21 and 30
// MiB.
void check_memory_of_outputs(const OutputConfig& output, const AreaConfig& area, std::uint64_t memory_limit) {
  constexpr std::uint64_t kMiB = 1 << 20, kLeast = 64, kReport = 32, kGis = 48;
  const bool has_gis = has_loops_for_gis(output) || area.is_check;
  const std::uint64_t least = kLeast + (output.report ? kReport : 0) + (has_gis ? kGis : 0);
  if (memory_limit == 0 || memory_limit >= least * kMiB) return;
  const std::string outputs = output.report && has_gis ? "a report and files for GIS"
                              : has_gis                ? "files for GIS"
                                                       : "a report";
  throw Error("memory_limit = " + std::to_string(memory_limit / kMiB) + "MiB is too little for " + outputs +
              "; allowed: at least " + std::to_string(least) + "MiB");
}

// The least void of a rule, in nominal spacings.
struct VoidRule {
  std::string_view name;
  double spacings;
};
constexpr VoidRule kVoidRules[] = {{"anps:", 4}, {"spacing2:", 2}};
constexpr const char* kAllowedRules =
    "a length above 0, or the nominal spacing of points after anps: or spacing2:, such as 2.8, 2.8m, "
    "anps:0.71m or anps:QL2";

// Nominal spacings of the Lidar Base Specification, in metres.
constexpr std::pair<std::string_view, double> kQualityLevels[] = {
    {"QL0", 0.35}, {"QL1", 0.35}, {"QL2", 0.71}, {"QL3", 1.41}};

// Reads a length and its unit, such as "0.71", "0.71m" or "0.71 m". False if it is none.
bool read_length(std::string_view text, VoidSize& size) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size.length);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.empty()) return true;
  while (text.starts_with(' ')) text.remove_prefix(1);
  const auto units = std::span(kUnitNames).subspan(1);
  const auto unit = std::ranges::find(units, text);
  if (unit != units.end()) size.unit = *unit;
  return unit != units.end();
}

}  // namespace

VoidSize void_size_of(const AreaConfig& area) {
  constexpr double kMost = 1e100;
  std::string_view length = area.void_rule;
  VoidSize size;
  double spacings = 1;
  for (const VoidRule& rule : kVoidRules) {
    if (!length.starts_with(rule.name)) continue;
    length.remove_prefix(rule.name.size());
    spacings = rule.spacings;
    size.is_standards = true;
    break;
  }
  const auto level = std::ranges::find(kQualityLevels, length, [](const auto& each) { return each.first; });
  const bool is_level = area.void_rule.starts_with("anps:") && level != std::end(kQualityLevels);
  if (is_level) {
    size.length = level->second;
    size.unit = kUnitNames[static_cast<std::size_t>(LengthUnit::kM)];
  }
  if ((!is_level && !read_length(length, size)) || !(size.length > 0 && size.length <= kMost))
    throw Error((area.void_rule.empty() ? "--void-rule is required for an area"
                                        : "void_rule = " + quote(area.void_rule)) +
                "; allowed: " + kAllowedRules);
  size.length *= spacings;
  return size;
}

std::string_view name_of(LengthUnit unit) {
  return kUnitNames[static_cast<std::size_t>(unit)];
}

std::vector<Parameter> file_parameters(FilesConfig& config) {
  InputConfig& input = config.input;
  AreaConfig& area = config.area;
  OutputConfig& output = config.output;
  const std::string_view no_points = config.results.points ? "" : "--points";
  const std::string_view no_gis = has_loops_for_gis(output) ? "" : "--gpkg or --geojson";
  return {
      {"input", "columns", Changes::kPoints, &input.columns, 0, 0,
       "column names, divided by commas or blanks",
       "Names of a text file's columns, such as x,y,z,nx,ny,nz or x=Ost,y=Nord,z=Hoehe; empty: from its "
       "header "
       "line."},
      {"input", "bounds", Changes::kPoints, &input.bounds, -1e30, 1e30,
       "4 numbers, min x y and max x y, or 6, min x y z and max x y z; none: no bounds",
       "Points outside of this box do not take part."},
      {"input", "leave_out", Changes::kPoints, &input.leave_out, -1e30, 1e30,
       "6 numbers, min x y z and max x y z, for each box; none: no box",
       "Points in these boxes do not take part."},
      flag("input", "drop_origin", Changes::kPoints, &input.drop_origin,
           "Points at 0 0 0, or at the scanner where a file has its place, do not take part."),
      flag("input", "keep_withheld", Changes::kPoints, &input.keep_withheld,
           "Points of LAS that are flagged as withheld take part."),
      flag("input", "keep_noise", Changes::kPoints, &input.keep_noise,
           "Points of LAS of the classes 7 and 18, which are noise, take part."),
      {"input", "where", Changes::kPoints, &input.where, 0, 0,
       "a condition such as Classification == 2 and PointSourceId != 7",
       "Points take part where this condition of their attributes holds; empty: all."},
      {"input", "trust", Changes::kPoints, named(input.trust, kTrust), 0, 2, "neither, header or file",
       "Which number of points holds where the header of LAS or E57 counts others than follow; neither: an "
       "error."},
      {"input", "crs", Changes::kPoints, &input.crs, 0, 0,
       "a code such as EPSG:25832, well-known text, or a file that has one of them",
       "Coordinate reference system of the scan, over what its files state; empty: as they state it."},
      {"input", "unit", Changes::kPoints, named(input.unit, kUnitNames), 0, 8,
       "input, m, km, cm, mm, ft, us-ft, in or yd",
       "Unit of the coordinates, over what the files state; input: as they, or --crs, state it."},
      {"input", "unit_z", Changes::kPoints, named(input.unit_z, kUnitNames), 0, 8,
       "input, m, km, cm, mm, ft, us-ft, in or yd",
       "Unit of z, where it is not the unit of x and y; input: as the files, or --crs, state it."},
      flag("input", "recursive", Changes::kPoints, &input.recursive,
           "Folders stand for the scan files in their subfolders, too."),
      flag("input", "skip_damaged", Changes::kPoints, &input.skip_damaged,
           "Files that cannot be read to their end do not take part; each is read once more to know it."),
      {"area", "area", Changes::kNothingKept, &area.area, 0, 0, "a file name, or nothing",
       "File of polygons, GeoPackage, GeoJSON or Shapefile, that the scan is to cover in plan; nothing: its "
       "own outline, as filters.hexbin of PDAL draws it."},
      {"area", "void_rule", Changes::kNothingKept, &area.void_rule, 0, 0, kAllowedRules,
       "Diameter of the smallest circle without points that is a void of the area; anps: four, spacing2: two "
       "nominal spacings."},
      {"area", "except", Changes::kNothingKept, &area.except, 0, 0, "a file name, or nothing",
       "File of polygons, such as water, in which voids do not count."},
      {"area", "classes", Changes::kNothingKept, &area.classes, 0, 0,
       "file names, divided by commas, or nothing",
       "Files of polygons, such as buildings.gpkg,water.gpkg, for the share of each void that lies in each."},
      {"area", "area_tile", Changes::kNothingKept, &area.area_tile, 0, 1e100,
       "a length of 0 (off) or more than the void size",
       "Edge of the squares of a table: area, voids, points and density of each."},
      {"output", "points_format", Changes::kNothingKept, named(output.points_format, kPointsFormats), 0, 2,
       "input, ply or csv",
       "One file for the annotated scan, as ply or csv; input: one for each file of the scan, in its format.",
       no_points},
      flag("output", "points_normals", Changes::kNothingKept, &output.points_normals,
           "Add the estimated normals to the annotated scan, unless a scan brings its own.", no_points),
      flag("output", "gpkg", Changes::kNothingKept, &output.gpkg,
           "Write loops.gpkg too: the loops as a GeoPackage, for QGIS and other GIS."),
      flag("output", "geojson", Changes::kNothingKept, &output.geojson,
           "Write loops.geojson too: the loops as GeoJSON, for GIS and the web."),
      flag("output", "lids", Changes::kNothingKept, &output.lids,
           "Write lids.ply too: a triangulated lid for each hole, a preview of filling. holes.csv has its "
           "area."),
      flag("output", "polygons", Changes::kNothingKept, &output.polygons,
           "Loops as polygons seen from above: a second layer of the GeoPackage; in place of lines in the "
           "others.",
           no_gis),
      {"output", "stations", Changes::kNothingKept, &output.stations, 0, 0, "a file name, or nothing",
       "File of where scanners stood, or the trajectory of one, from which the cause of each hole is found; "
       "without it, as the scans say."},
      {"output", "coverage", Changes::kNothingKept, &output.coverage, 0, 1e100, "a length of 0 (off) or more",
       "Write coverage.tif too: points and share of holes in cells of this edge, seen from above, for GIS."},
      flag("output", "no_coordinates", Changes::kNothingKept, &output.no_coordinates,
           "Leave the coordinates of loops out of holes.json, which then has the ids of their points alone."),
      flag("output", "local_coordinates", Changes::kNothingKept, &output.local_coordinates,
           "Coordinates of PLY files are 32-bit floats relative to an offset, which their headers state."),
      flag("output", "report", Changes::kNothingKept, &output.report,
           "Write report.html too: the scan and its holes in 3D, for a browser."),
  };
}

std::vector<Parameter> parameters(FilesConfig& config) {
  std::vector<Parameter> all = lacuna::parameters(config);
  if (!config.output.points_normals)
    std::ranges::find(all, "orient_normals", &Parameter::key)->missing = "--points --points-normals";
  const std::vector<Parameter> of_files = file_parameters(config);
  all.insert(all.end(), of_files.begin(), of_files.end());
  constexpr std::string_view kLastSections[] = {"run", "output"};  // from the end
  std::ranges::stable_sort(all, {}, [&](const Parameter& parameter) {
    return std::end(kLastSections) - std::ranges::find(kLastSections, parameter.section);
  });
  return all;
}

void check_config(const FilesConfig& config) {
  lacuna::check_config(config);
  FilesConfig checked = config;
  check_ranges(file_parameters(checked));
  check_boxes(config.input);
  if (config.area.is_check) void_size_of(config.area);
  check_memory_of_outputs(config.output, config.area, config.run.memory_limit);
}

}  // namespace lacuna::io
