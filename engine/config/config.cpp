// SPDX-License-Identifier: Apache-2.0
// The one list of the engine's parameters, and what their values may be together. Three of them are in
// [output], with parameters of files.
#include "engine/config/config.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna {
namespace {

constexpr double kAboveZero = std::numeric_limits<double>::min();
constexpr double kLeastMemory = 64.0 * 1024 * 1024;

// In the order of their enumerations.
constexpr std::string_view kMethods[] = {"tangential", "paper"};
constexpr std::string_view kNormalsUses[] = {"fitting", "given", "estimated"};

}  // namespace

std::string_view name_of(LoopMethod method) {
  return kMethods[static_cast<std::size_t>(method)];
}

std::vector<Parameter> parameters(Config& config) {
  auto& [scale, neighbourhood, normals, criteria, coherence, loops, spanning, tangential, selection, results,
         run] = config;
  const bool is_paper = loops.method == LoopMethod::kPaper;
  const std::string_view no_paper = is_paper ? "" : "--method paper";
  const std::string_view no_tangential = is_paper ? "--method tangential" : "";
  const std::string_view no_normals = results.points ? "" : "--points --points-normals";
  const double below_90 = std::nextafter(90.0, 0.0);
  std::vector<Parameter> all = {
      {"scale", "resolution", Changes::kPoints, &scale.resolution, 0, 1e100, "a length of 0 (off) or more",
       "The scan at this one level: one point represents each cell of an absolute lattice with edges of this "
       "length, in units of the scan. 0: all levels."},
      {"scale", "min_hole", Changes::kPoints, &scale.min_hole, 0, 1e100, "a length of 0 (off) or more",
       "Diameter of the smallest circle that fits in a wanted hole, in units of the scan; sets the first "
       "level."},
      flag("scale", "every_point", Changes::kPoints, &scale.every_point,
           "The scan at one level, that of all points.", no_tangential),

      {"neighbourhood", "k", Changes::kPoints, &neighbourhood.k, 1, 1000, "a whole number from 1 to 1000",
       "Nearest neighbours of a point, before the neighbourhoods are made symmetric."},
      {"neighbourhood", "eps", Changes::kPoints, &neighbourhood.eps, 0, 1e150, "a length of 0 (off) or more",
       "Radius, in units of the scan, within which every point is a neighbour too."},
      {"neighbourhood", "eps_fraction", Changes::kPoints, &neighbourhood.eps_fraction, 0, 1,
       "a number from 0 (off) to 1",
       "That radius as a fraction of the bounding box's diagonal; set at most one of the two.", "", true},

      {"normals", "normals", Changes::kEvaluation, named(normals.use, kNormalsUses), 0, 2,
       "fitting, given or estimated",
       "Normals of the files: fitting, used where within 45 degrees of the estimated one; given, used; "
       "estimated, not used."},
      {"normals", "crease_threshold", Changes::kEvaluation, &normals.crease_threshold, 0, 1,
       "a number from 0 to 1", "Angle probability above which an estimated normal is turned at a crease.", "",
       true},
      flag("normals", "orient_normals", Changes::kOutputs, &normals.orient,
           "Orient normals consistently, by minimum spanning tree.", no_normals),

      {"criteria", "sigma", Changes::kEvaluation, &criteria.sigma, kAboveZero, 1000,
       "a number above 0, at most 1000",
       "Width of the Gauss weights, as a multiple of a point's mean distance to its neighbours.", "", true},
      {"criteria", "cone", Changes::kEvaluation, &criteria.cone, 0, below_90,
       "degrees from 0 (off) to less than 90",
       "Angle around the normal line within which directions to neighbours are not used.", "", true},
  };
  for (std::size_t i = 0; i < lacuna::criteria().size(); ++i) {
    const Criterion& criterion = lacuna::criteria()[i];
    all.push_back({"criteria", criterion.weight_key, Changes::kEvaluation, &criteria.weights.at(i), 0, 1e6,
                   "a number from 0 to 1000000", criterion.help, "", true});
  }
  const std::vector<Parameter> others = {
      {"coherence", "threshold", Changes::kEvaluation, &coherence.threshold, 0, 1, "a number from 0 to 1",
       "Boundary probability above which a point is a candidate.", "", true},

      {"loops", "method", Changes::kEvaluation, named(loops.method, kMethods), 0, 1, "tangential or paper",
       "How loops are found: tangential, as the boundary of the triangles on which neighbouring points "
       "agree; "
       "paper, as Bendels et al. do."},

      {"spanning", "max_prob_weight", Changes::kEvaluation, &spanning.max_prob_weight, 0, 1e9,
       "a number from 0 to 1000000000",
       "Method paper: an edge takes part if its probability weight is below this.", no_paper, true},
      {"spanning", "max_total_weight", Changes::kEvaluation, &spanning.max_total_weight, 0, 1e9,
       "a number from 0 to 1000000000", "Method paper: an edge takes part if its total weight is below this.",
       no_paper, true},
      {"spanning", "e", Changes::kEvaluation, &spanning.e, 0, 1e9,
       "a whole number from 0 (automatic) to 1000000000",
       "Method paper: loops have more than this many edges; 0: round(2 sqrt(pi K)), K the mean number of "
       "neighbours.",
       no_paper, true},

      {"tangential", "seed_probability", Changes::kEvaluation, &tangential.seed_probability, 0, 1,
       "a number from 0 to 1",
       "Boundary probability above which a candidate is a seed; loops are searched from these.",
       no_tangential, true},
      {"tangential", "max_radius", Changes::kEvaluation, &tangential.max_radius, 0.5, 4,
       "a number from 0.5 to 4",
       "Largest circumradius of a triangle, in medians of those around it; their spread is added.",
       no_tangential, true},
      {"tangential", "hole_radius", Changes::kEvaluation, &tangential.hole_radius, 0.1, 4,
       "a number from 0.1 to 4",
       "Circumradius above which a triangle lies in a hole, in mean distances to neighbours; medians leave "
       "it "
       "out.",
       no_tangential, true},
      {"tangential", "most_radius", Changes::kEvaluation, &tangential.most_radius, 0.1, 1,
       "a number from 0.1 to 1",
       "Bound of the median circumradius and of the spread, in mean distances to neighbours.", no_tangential,
       true},
      {"tangential", "coarse_bound", Changes::kEvaluation, &tangential.coarse_bound, 1, 10,
       "a number from 1 to 10",
       "Curves are found again within this many times the largest circumradius; tracking chooses.",
       no_tangential, true},
      {"tangential", "clear_radius", Changes::kEvaluation, &tangential.clear_radius, 1.001, 100,
       "a number from 1.001 to 100",
       "Circumradii that many times as large as the sampling radius count fully for a loop's clearness.",
       no_tangential, true},
      {"tangential", "added_length", Changes::kEvaluation, &tangential.added_length, 0, 1000,
       "a number from 0 to 1000",
       "Length without clearness that is added to each boundary curve, in circumradii of the sampling.",
       no_tangential, true},
      {"tangential", "min_curve", Changes::kEvaluation, &tangential.min_curve, 3, 1e9,
       "a whole number from 3 to 1000000000", "Boundary curves with fewer points are no loops.",
       no_tangential, true},

      {"selection", "min_confidence", Changes::kNothingKept, &selection.min_confidence, 0, 1,
       "a number from 0 to 1", "Loops with a lower confidence are not reported.", no_tangential},
      {"selection", "min_perimeter", Changes::kNothingKept, &selection.min_perimeter, 0, 1e300,
       "a length of 0 or more", "Loops with a smaller perimeter are not reported."},
      {"selection", "min_diameter", Changes::kNothingKept, &selection.min_diameter, 0, 1e300,
       "a length of 0 or more", "Loops with a smaller diameter are not reported; 0: as min_hole has it."},
      {"selection", "min_points", Changes::kNothingKept, &selection.min_points, 0, 1e15,
       "a whole number from 0 to 10^15", "Loops with fewer points are not reported."},
      flag("selection", "holes_only", Changes::kNothingKept, &selection.holes_only,
           "Report holes only, not the outer boundaries of open surfaces."),

      flag("output", "points", Changes::kOutputs, &results.points,
           "Write the annotated scan too: every point of the input with its probabilities."),
      {"output", "sample_points", Changes::kOutputs, &results.sample_points, 0, 1e8,
       "a whole number from 0 to 100000000",
       "Points of sample.ply at most, spread evenly over the surface, for report and render; 0: no sample."},

      {"run", "threads", Changes::kProcess, &run.threads, 0, 1024,
       "a whole number from 0 (one per core) to 1024", "Threads at work; 0: one per core."},
      {"run", "memory_limit", Changes::kProcess, &run.memory_limit, kLeastMemory, 0x1p60,
       "0 (automatic) or a size of at least 64MiB, such as 512MiB, 2GiB or 4000000000",
       "Memory that the run may take; 0: half of the machine's."},
      {"run", "tile_points", Changes::kNothingKept, &run.tile_points, 0, 1e9,
       "a whole number from 0 (automatic) to 1000000000",
       "Points per tile at most; 0: chosen from threads and memory limit."},
      {"run", "workspace", Changes::kNothingKept, &run.workspace, 0, 0, "the name of a folder",
       "Folder in which a run keeps what it has done, so that the same command goes on after a stop; empty: "
       "none."},
      {"run", "scratch", Changes::kProcess, &run.scratch, 0, 0, "the name of a folder",
       "Folder for temporary files; empty: inside the workspace, else inside the output folder."},
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

double first_edge(const ScaleConfig& scale) {
  if (scale.resolution > 0 || scale.every_point) return scale.resolution;
  return scale.min_hole / kCellsAcross;
}

void check_config(const Config& config) {
  const std::vector<double>& weights = config.criteria.weights;
  if (weights.size() != criteria().size()) {
    throw Error(std::to_string(weights.size()) +
                " weights of criteria; allowed: " + std::to_string(criteria().size()));
  }
  Config checked = config;
  check_ranges(parameters(checked));

  const NeighbourhoodConfig& neighbourhood = config.neighbourhood;
  if (neighbourhood.eps > 0 && neighbourhood.eps_fraction > 0) {
    throw Error("eps and eps_fraction are both set; allowed: at most one of them above 0");
  }
  if (config.scale.every_point && config.scale.resolution > 0)
    throw Error("every_point and resolution are both set; allowed: at most one of them");
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) {
    std::string names;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (i > 0) names += i + 1 < weights.size() ? ", " : " and ";
      names += criteria()[i].weight_key;
    }
    throw Error(names + " are all 0; allowed: at least one above 0");
  }
}

Config effective(const Config& config) {
  check_config(config);
  return with_min_hole(config);
}

}  // namespace lacuna
