// SPDX-License-Identifier: Apache-2.0
// The measures of loops by name, for all writers. A new one is a line of this table. holes.json alone has its
// own list, which its schema describes.
#pragma once

#include "engine/model/loop.hpp"

#include <array>
#include <string_view>

namespace lacuna::io {

struct LoopMeasure {
  std::string_view name;
  std::string_view short_name;  // at most 10 characters: a column of a Shapefile
  double (*of)(const LoopMeasures& loop);
  bool is_count = false;  // a whole number
};

template <Cause cause>
double share_of(const LoopMeasures& loop) {
  return loop.cause.share(cause);
}

inline constexpr auto kLoopMeasures = std::to_array<LoopMeasure>({
    {"points", "points", [](const LoopMeasures& loop) { return static_cast<double>(loop.points); }, true},
    {"confidence", "confidence", [](const LoopMeasures& loop) { return loop.track.confidence; }},
    {"persistence", "persist", [](const LoopMeasures& loop) { return loop.track.persistence; }},
    {"first_scale", "first_scal", [](const LoopMeasures& loop) { return loop.track.first_scale; }},
    {"last_scale", "last_scale", [](const LoopMeasures& loop) { return loop.track.last_scale; }},
    {"perimeter", "perimeter", [](const LoopMeasures& loop) { return loop.perimeter; }},
    {"area", "area", [](const LoopMeasures& loop) { return loop.area; }},
    {"diameter", "diameter", [](const LoopMeasures& loop) { return loop.diameter; }},
    {"planarity", "planarity", [](const LoopMeasures& loop) { return loop.planarity; }},
    {"mean_probability", "mean_prob", [](const LoopMeasures& loop) { return loop.mean_probability; }},
    {"hidden", "hidden", share_of<Cause::kHidden>},
    {"opening", "opening", share_of<Cause::kOpening>},
    {"out_of_view", "out_view", share_of<Cause::kOutOfView>},
    {"no_return", "no_return", share_of<Cause::kNoReturn>},
    {"filtered", "filtered", share_of<Cause::kFiltered>},
});

}  // namespace lacuna::io
