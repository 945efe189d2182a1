// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/paper/eligible_edges.hpp"

#include "engine/evaluate/evaluate.hpp"

#include <cmath>

namespace lacuna::paper {

double eligible_weight(const Strength& a, const Strength& b, double distance, const SpanningConfig& config) {
  constexpr double kNot = -1;
  const double prob_weight = (2 - double{a.probability}) - double{b.probability};
  if (!(prob_weight < config.max_prob_weight)) return kNot;
  const double total = prob_weight + round_to_step(2 * distance / (a.mean_distance + b.mean_distance));
  return total < config.max_total_weight ? total : kNot;
}

bool is_strong(double probability, const SpanningConfig& config) {
  return probability >
         1 - config.max_prob_weight / 2 - kProbabilityStep;  // one step of slack for the halving
}

TileEdges eligible_edges(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                         std::span<const Evaluation> evaluations, const SpanningConfig& config) {
  const auto strength = [&](LocalIndex p) {
    return Strength{evaluations[p].mean_distance, static_cast<float>(evaluations[p].probability)};
  };
  TileEdges edges;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    if (!is_strong(evaluations[p].probability, config)) continue;
    for (const LocalIndex q : neighbourhoods[p]) {
      const double distance = std::sqrt(squared_distance(points.positions[p], points.positions[q]));
      if (!points.is_owned(q)) {
        edges.crossings.push_back({p, q, distance});
        continue;
      }
      const bool sent_by_other =
          is_strong(evaluations[q].probability, config) && points.ids[q] < points.ids[p];
      if (sent_by_other) continue;
      const double weight = eligible_weight(strength(p), strength(q), distance, config);
      if (weight >= 0) edges.inside.push_back({p, q, weight});
    }
  }
  return edges;
}

}  // namespace lacuna::paper
