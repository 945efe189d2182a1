// SPDX-License-Identifier: Apache-2.0
// The one list of all parameters.
#include "engine/config/config.hpp"
#include "engine/criteria/criteria.hpp"

#include <cmath>
#include <limits>

namespace lacuna {
namespace {

constexpr double kAboveZero = std::numeric_limits<double>::min();
constexpr double kLeastMemory = 64.0 * 1024 * 1024;

// In the order of their enumerations.
constexpr std::string_view kMethods[] = {"tangential", "paper"};
constexpr std::string_view kReturns[] = {"all", "first", "last", "only"};
constexpr std::string_view kUnits[] = {"input", "m", "km", "cm", "mm", "ft", "us-ft", "in", "yd"};
constexpr std::string_view kPointsFormats[] = {"input", "ply", "las", "pcd", "csv", "laz"};

template <class Enum>
NamedValue named(Enum& value, std::span<const std::string_view> names) {
  static_assert(sizeof(Enum) == sizeof(std::uint8_t));
  return {reinterpret_cast<std::uint8_t*>(&value), names};
}

constexpr Need kNothing{"", [](const Config&) { return true; }};
constexpr Need kTangential{"--method tangential",
                           [](const Config& c) { return c.loops.method == LoopMethod::kTangential; }};
constexpr Need kPaper{"--method paper", [](const Config& c) { return c.loops.method == LoopMethod::kPaper; }};
constexpr Need kPoints{"--points", [](const Config& c) { return c.output.points; }};
constexpr Need kPointsFiles{"--points or --cut-outs",
                            [](const Config& c) { return c.output.points || c.output.cut_outs > 0; }};
constexpr Need kGis{"--gpkg, --geojson or --shp",
                    [](const Config& c) { return c.output.gpkg || c.output.geojson || c.output.shp; }};
constexpr Need kPointsNormals{"--points --normals",
                              [](const Config& c) { return c.output.points && c.output.normals; }};

}  // namespace

std::string_view name_of(LoopMethod method) {
  return kMethods[static_cast<std::size_t>(method)];
}

std::string_view name_of(LengthUnit unit) {
  return kUnits[static_cast<std::size_t>(unit)];
}

std::vector<Parameter> parameters(Config& config) {
  auto& [scale, neighbourhood, normals, criteria, coherence, loops, spanning, tangential, selection, input,
         output, run] = config;
  const double below_90 = std::nextafter(90.0, 0.0);
  std::vector<Parameter> all = {
      {"scale", "resolution", &scale.resolution, 0, 1e100, "a length of 0 (off) or more",
       "The scan at this one level: one point represents each cell of an absolute lattice with edges of this "
       "length, in units of the scan. 0: all levels.",
       kNothing},
      {"scale", "min_hole", &scale.min_hole, 0, 1e100, "a length of 0 (off) or more",
       "Diameter of the smallest circle that fits in a wanted hole, in units of the scan; sets the first "
       "level.",
       kNothing},
      {"scale", "every_point", &scale.every_point, 0, 1, "true or false",
       "The scan at one level, that of all points.", kTangential},

      {"neighbourhood", "k", &neighbourhood.k, 1, 1000, "a whole number from 1 to 1000",
       "Nearest neighbours of a point, before the neighbourhoods are made symmetric.", kNothing},
      {"neighbourhood", "eps", &neighbourhood.eps, 0, 1e150, "a length of 0 (off) or more",
       "Radius, in units of the scan, within which every point is a neighbour too.", kNothing},
      {"neighbourhood", "eps_fraction", &neighbourhood.eps_fraction, 0, 1, "a number from 0 (off) to 1",
       "That radius as a fraction of the bounding box's diagonal; set at most one of the two.", kNothing},

      {"normals", "crease_threshold", &normals.crease_threshold, 0, 1, "a number from 0 to 1",
       "Angle probability above which an estimated normal is turned at a crease.", kNothing},
      {"normals", "orient_normals", &normals.orient, 0, 1, "true or false",
       "Orient normals consistently, by minimum spanning tree.", kPointsNormals},

      {"criteria", "sigma", &criteria.sigma, kAboveZero, 1000, "a number above 0, at most 1000",
       "Width of the Gauss weights, as a multiple of a point's mean distance to its neighbours.", kNothing},
      {"criteria", "cone", &criteria.cone, 0, below_90, "degrees from 0 (off) to less than 90",
       "Angle around the normal line within which directions to neighbours are not used.", kNothing},
  };
  for (std::size_t i = 0; i < lacuna::criteria().size(); ++i) {
    const Criterion& criterion = lacuna::criteria()[i];
    all.push_back({"criteria", criterion.weight_key, &criteria.weights.at(i), 0, 1e6,
                   "a number from 0 to 1000000", criterion.help, kNothing});
  }
  const std::vector<Parameter> others = {
      {"coherence", "threshold", &coherence.threshold, 0, 1, "a number from 0 to 1",
       "Boundary probability above which a point is a candidate.", kNothing},

      {"loops", "method", named(loops.method, kMethods), 0, 1, "tangential or paper",
       "How loops are found: tangential, as the boundary of the triangles on which neighbouring points "
       "agree; "
       "paper, as Bendels et al. do.",
       kNothing},

      {"spanning", "max_prob_weight", &spanning.max_prob_weight, 0, 1e9, "a number from 0 to 1000000000",
       "Method paper: an edge takes part if its probability weight is below this.", kPaper},
      {"spanning", "max_total_weight", &spanning.max_total_weight, 0, 1e9, "a number from 0 to 1000000000",
       "Method paper: an edge takes part if its total weight is below this.", kPaper},
      {"spanning", "e", &spanning.e, 0, 1e9, "a whole number from 0 (automatic) to 1000000000",
       "Method paper: loops have more than this many edges; 0: round(2 sqrt(pi K)), K the mean number of "
       "neighbours.",
       kPaper},

      {"tangential", "seed_probability", &tangential.seed_probability, 0, 1, "a number from 0 to 1",
       "Boundary probability above which a candidate is a seed; loops are searched from these.", kTangential},
      {"tangential", "max_radius", &tangential.max_radius, 0.5, 4, "a number from 0.5 to 4",
       "Largest circumradius of a triangle, in medians of those around it; their spread is added.",
       kTangential},
      {"tangential", "hole_radius", &tangential.hole_radius, 0.1, 4, "a number from 0.1 to 4",
       "Circumradius above which a triangle lies in a hole, in mean distances to neighbours; medians leave "
       "it "
       "out.",
       kTangential},
      {"tangential", "most_radius", &tangential.most_radius, 0.1, 1, "a number from 0.1 to 1",
       "Bound of the median circumradius and of the spread, in mean distances to neighbours.", kTangential},
      {"tangential", "coarse_bound", &tangential.coarse_bound, 1, 10, "a number from 1 to 10",
       "Curves are found again within this many times the largest circumradius; tracking chooses.",
       kTangential},
      {"tangential", "clear_radius", &tangential.clear_radius, 1.001, 100, "a number from 1.001 to 100",
       "Circumradii that many times as large as the sampling radius count fully for a loop's clearness.",
       kTangential},
      {"tangential", "added_length", &tangential.added_length, 0, 1000, "a number from 0 to 1000",
       "Length without clearness that is added to each boundary curve, in circumradii of the sampling.",
       kTangential},
      {"tangential", "min_curve", &tangential.min_curve, 3, 1e9, "a whole number from 3 to 1000000000",
       "Boundary curves with fewer points are no loops.", kTangential},

      {"selection", "min_confidence", &selection.min_confidence, 0, 1, "a number from 0 to 1",
       "Loops with a lower confidence are not reported.", kTangential},
      {"selection", "min_perimeter", &selection.min_perimeter, 0, 1e300, "a length of 0 or more",
       "Loops with a smaller perimeter are not reported.", kNothing},
      {"selection", "max_perimeter", &selection.max_perimeter, 0, 1e300, "a length of 0 (no limit) or more",
       "Loops with a larger perimeter are not reported; 0: no limit.", kNothing},
      {"selection", "min_diameter", &selection.min_diameter, 0, 1e300, "a length of 0 or more",
       "Loops with a smaller diameter are not reported; 0: as min_hole has it.", kNothing},
      {"selection", "min_points", &selection.min_points, 0, 1e15, "a whole number from 0 to 10^15",
       "Loops with fewer points are not reported.", kNothing},
      {"selection", "holes_only", &selection.holes_only, 0, 1, "true or false",
       "Report holes only, not the outer boundaries of open surfaces.", kNothing},

      {"input", "columns", &input.columns, 0, 0, "column names, separated by spaces",
       "Names of a text file's columns, such as x y z nx ny nz; empty: from its header line.", kNothing},
      {"input", "bounds", &input.bounds, -1e153, 1e153,
       "4 numbers, min x y and max x y, or 6, min x y z and max x y z; none: no bounds",
       "Points outside of this box do not take part.", kNothing},
      {"input", "leave_out", &input.leave_out, -1e153, 1e153,
       "6 numbers, min x y z and max x y z, for each box; none: no box",
       "Points in these boxes do not take part.", kNothing},
      {"input", "classes", &input.classes, 0, 255, "whole numbers from 0 to 255; none: all classes",
       "Points of other classes do not take part; the property classification has them.", kNothing},
      {"input", "returns", named(input.returns, kReturns), 0, 3, "all, first, last or only",
       "Other returns of a laser pulse do not take part; only: of pulses with one return.", kNothing},
      {"input", "drop_origin", &input.drop_origin, 0, 1, "true or false",
       "Points at 0 0 0, or at the scanner where a file has its place, do not take part.", kNothing},
      {"input", "crs", &input.crs, 0, 0,
       "a code such as EPSG:25832, well-known text, or a file that has one of them",
       "Coordinate reference system of the scan, over what its files state; empty: as they state it.",
       kNothing},
      {"input", "unit", named(input.unit, kUnits), 0, 8, "input, m, km, cm, mm, ft, us-ft, in or yd",
       "Unit of the coordinates, over what the files state; input: as they, or --crs, state it.", kNothing},

      {"output", "points", &output.points, 0, 1, "true or false",
       "Write the annotated scan too: every point of the input with its probabilities.", kNothing},
      {"output", "points_format", named(output.points_format, kPointsFormats), 0, 5,
       "input, ply, las, pcd, csv or laz",
       "Format of the annotated scan and of cut-outs; input: that of the scan, PLY where it cannot be "
       "written.",
       kPointsFiles},
      {"output", "normals", &output.normals, 0, 1, "true or false",
       "Add the estimated normals to the annotated scan, unless a scan brings its own.", kPoints},
      {"output", "vdb", &output.vdb, 0, 1, "true or false",
       "Write probability.vdb too: the boundary probability as a grid of OpenVDB, for Houdini and Blender.",
       kNothing},
      {"output", "obj", &output.obj, 0, 1, "true or false",
       "Write loops.obj too: the loops as polylines, for CAD and Blender.", kNothing},
      {"output", "dxf", &output.dxf, 0, 1, "true or false",
       "Write loops.dxf too: the loops as closed 3D polylines, for CAD.", kNothing},
      {"output", "vtp", &output.vtp, 0, 1, "true or false",
       "Write loops.vtp too: the loops with their measures, for ParaView and VTK.", kNothing},
      {"output", "gpkg", &output.gpkg, 0, 1, "true or false",
       "Write loops.gpkg too: the loops as a GeoPackage, for QGIS and other GIS.", kNothing},
      {"output", "geojson", &output.geojson, 0, 1, "true or false",
       "Write loops.geojson too: the loops as GeoJSON, for GIS and the web.", kNothing},
      {"output", "shp", &output.shp, 0, 1, "true or false",
       "Write loops.shp too, with its .shx, .dbf and .prj: the loops as a Shapefile.", kNothing},
      {"output", "lids", &output.lids, 0, 1, "true or false",
       "Write lids.obj, lids.ply and lids.csv too: a triangulated lid for each hole, a preview of filling.",
       kNothing},
      {"output", "polygons", &output.polygons, 0, 1, "true or false",
       "Loops as polygons seen from above: a second layer of the GeoPackage; in place of lines in the "
       "others.",
       kGis},
      {"output", "stations", &output.stations, 0, 0, "a file name, or nothing",
       "File of where scanners stood, or the trajectory of one, from which the cause of each hole is found; "
       "without it, as the scans say.",
       kNothing},
      {"output", "coverage", &output.coverage, 0, 1e100, "a length of 0 (off) or more",
       "Write coverage.tif too: points and share of holes in cells of this edge, seen from above, for GIS.",
       kNothing},
      {"output", "cut_outs", &output.cut_outs, 0, 1e100, "a length of 0 (off) or more",
       "Write a file for each hole too: the points in the loop's box of x, y and z, widened by this length.",
       kNothing},
      {"output", "no_coordinates", &output.no_coordinates, 0, 1, "true or false",
       "Leave the coordinates of loops out of holes.json, which then has the ids of their points alone.",
       kNothing},
      {"output", "local_coordinates", &output.local_coordinates, 0, 1, "true or false",
       "Coordinates of PLY and PCD files are 32-bit floats relative to an offset, which their headers state.",
       kNothing},
      {"output", "sample_points", &output.sample_points, 0, 1e8, "a whole number from 0 to 100000000",
       "Points of sample.ply at most, spread evenly over the surface, for report and render; 0: no sample.",
       kNothing},
      {"output", "report", &output.report, 0, 1, "true or false",
       "Write report.html too: the scan and its holes in 3D, for a browser.", kNothing},

      {"run", "threads", &run.threads, 0, 1024, "a whole number from 0 (one per core) to 1024",
       "Threads at work; 0: one per core.", kNothing},
      {"run", "memory_limit", &run.memory_limit, kLeastMemory, 0x1p60,
       "0 (automatic) or a size of at least 64MiB, such as 512MiB, 2GiB or 4000000000",
       "Memory that the run may take; 0: half of the machine's.", kNothing},
      {"run", "tile_points", &run.tile_points, 0, 1e9, "a whole number from 0 (automatic) to 1000000000",
       "Points per tile at most; 0: chosen from threads and memory limit.", kNothing},
      {"run", "workspace", &run.workspace, 0, 0, "the name of a folder",
       "Folder in which a run keeps what it has done, so that the same command goes on after a stop; empty: "
       "none.",
       kNothing},
      {"run", "scratch", &run.scratch, 0, 0, "the name of a folder",
       "Folder for temporary files; empty: inside the workspace, else inside the output folder.", kNothing},
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace lacuna
