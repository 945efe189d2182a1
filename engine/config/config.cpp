// SPDX-License-Identifier: Apache-2.0
#include "engine/config/config.hpp"

#include "engine/criteria/criteria.hpp"
#include "engine/run/error.hpp"

#include <algorithm>

namespace lacuna {
namespace {

void check_limits(const std::string& measure, double min, double max) {
  if (max == 0 || max >= min) return;
  throw Error("max_" + measure + " = " + print_number(max) + " is less than min_" + measure + " = " +
              print_number(min) + "; allowed: 0 (no limit) or at least min_" + measure);
}

}  // namespace

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
  const SelectionConfig& selection = config.selection;
  check_limits("perimeter", selection.min_perimeter, selection.max_perimeter);
  check_limits("area", selection.min_area, selection.max_area);
}

Config effective(const Config& config) {
  check_config(config);
  return with_min_hole(config);
}

}  // namespace lacuna
