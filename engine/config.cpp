// SPDX-License-Identifier: Apache-2.0
#include "engine/config.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/parameter_values.hpp"
#include "engine/run/error.hpp"

#include <algorithm>

namespace lacuna {
namespace {

// Checks a box: min along each axis, then max along each.
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
                " numbers; allowed: 4 (min x y, max x y) or 6 (min x y z, max x y z), divided by commas");
  check_box("bounds", bounds);
  const std::span<const double> boxes = input.leave_out;
  if (boxes.size() % 6 != 0)
    throw Error("leave_out has " + std::to_string(boxes.size()) +
                " numbers; allowed: 6 for each box (min x y z, max x y z), divided by commas");
  for (std::size_t at = 0; at < boxes.size(); at += 6) check_box("boxes of leave_out", boxes.subspan(at, 6));
}

// A report is put together in memory, and GDAL has memory of its own. Measured in addition to the rest, in
// MiB: 21 for a report, and 30 for GDAL.
void check_memory_of_outputs(const OutputConfig& output, std::uint64_t memory_limit) {
  constexpr std::uint64_t kMiB = 1 << 20, kLeast = 64, kReport = 32, kGis = 48;
  const bool is_gis = output.gpkg || output.geojson || output.shp;
  const std::uint64_t least = kLeast + (output.report ? kReport : 0) + (is_gis ? kGis : 0);
  if (memory_limit == 0 || memory_limit >= least * kMiB) return;
  const std::string outputs = output.report && is_gis ? "a report and files for GIS"
                              : is_gis                ? "files for GIS"
                                                      : "a report";
  throw Error("memory_limit = " + std::to_string(memory_limit / kMiB) + "MiB is too little for " + outputs +
              "; allowed: at least " + std::to_string(least) + "MiB");
}

}  // namespace

double first_edge(const ScaleConfig& scale) {
  if (scale.resolution > 0 || scale.every_point) return scale.resolution;
  return scale.min_hole / kCellsAcross;
}

Config with_min_hole(Config config) {
  if (config.selection.min_diameter == 0) config.selection.min_diameter = config.scale.min_hole;
  return config;
}

void check_config(const Config& config) {
  const std::vector<double>& weights = config.criteria.weights;
  if (weights.size() != criteria().size()) {
    throw Error(std::to_string(weights.size()) +
                " weights of criteria; allowed: " + std::to_string(criteria().size()));
  }
  Config checked = config;
  for (const Parameter& parameter : parameters(checked)) {
    std::visit(
        [&parameter](const auto& value) {
          if constexpr (requires { static_cast<double>(*value); }) {
            if (!in_range(parameter, static_cast<double>(*value))) refuse(parameter, parameter.print());
          }
        },
        parameter.value);
  }

  check_boxes(config.input);
  const NeighbourhoodConfig& neighbourhood = config.neighbourhood;
  if (neighbourhood.eps > 0 && neighbourhood.eps_fraction > 0) {
    throw Error("eps and eps_fraction are both set; allowed: at most one of them above 0");
  }
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) {
    std::string names;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (i > 0) names += i + 1 < weights.size() ? ", " : " and ";
      names += criteria()[i].weight_key;
    }
    throw Error(names + " are all 0; allowed: at least one above 0");
  }
  check_memory_of_outputs(config.output, config.run.memory_limit);
  const SelectionConfig& selection = config.selection;
  if (selection.max_perimeter > 0 && selection.max_perimeter < selection.min_perimeter) {
    throw Error("max_perimeter = " + print_number(selection.max_perimeter) +
                " is less than min_perimeter = " + print_number(selection.min_perimeter) +
                "; allowed: 0 (no limit) or at least min_perimeter");
  }
}

}  // namespace lacuna
