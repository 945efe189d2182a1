// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/hole_width.hpp"

#include "bench/evaluation/loop_kind.hpp"
#include "bench/evaluation/loop_size.hpp"
#include "bench/evaluation/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lacuna::evaluation {

std::optional<double> hole_width(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions,
                                 std::span<const Eigen::Vector3d> points, const PointTree& tree) {
  LoopIds ids;
  for (const auto& edge : loop.edges) ids.push_back(edge[0]);
  if ((loop.kind ? loop.kind : kind_of(ids, positions, points, tree)) != LoopKind::kHole) return std::nullopt;
  double spacings = 0;
  for (const std::uint64_t id : loop.vertices) spacings += spacing_at(positions[id], tree);
  const LoopSize size = size_of(loop, positions);
  const double width =
      2 * size.area / size.perimeter / (spacings / static_cast<double>(loop.vertices.size()));
  return std::isfinite(width) ? std::optional(width) : std::nullopt;
}

HolesByWidth holes_by_width(std::span<const std::optional<double>> widths,
                            std::span<const TrueMatch> matches) {
  HolesByWidth holes;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].counts || !widths[i]) continue;
    const auto end = std::upper_bound(kWidths.begin(), kWidths.end(), *widths[i]);
    Tally& tally = holes[static_cast<std::size_t>(end - kWidths.begin()) - 1];
    ++tally.all;
    tally.found += matches[i].found_by.has_value();
  }
  return holes;
}

}  // namespace lacuna::evaluation
