// SPDX-License-Identifier: Apache-2.0
// The measures of loops by name, and their colours. A new measure is a line of this table. The first ones are
// columns of holes.csv and of files for GIS; the report has all. holes.json has its own list, which its schema
// describes.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/stations/cause.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace lacuna::io {

struct LoopMeasure {
  std::string_view name;
  double (*of)(const ExplainedLoop& loop);  // NaN where there is none
  bool is_count = false;                    // a whole number
};

template <Cause cause>
double share_of(const ExplainedLoop& loop) {
  return loop.cause.share(cause);
}

inline constexpr auto kLoopMeasures = std::to_array<LoopMeasure>({
    {"points", [](const ExplainedLoop& loop) { return static_cast<double>(loop.points); }, true},
    {"confidence", [](const ExplainedLoop& loop) { return loop.track.confidence; }},
    {"perimeter", [](const ExplainedLoop& loop) { return loop.perimeter; }},
    {"area", [](const ExplainedLoop& loop) { return loop.area; }},
    {"diameter", [](const ExplainedLoop& loop) { return loop.diameter; }},
    {"parent",
     [](const ExplainedLoop& loop) {
       return loop.parent < 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(loop.parent);
     },
     true},
    {"prominence", [](const ExplainedLoop& loop) { return loop.track.evidence.prominence; }},
    {"first_scale", [](const ExplainedLoop& loop) { return loop.track.first_scale; }},
    {"last_scale", [](const ExplainedLoop& loop) { return loop.track.last_scale; }},
    {"planarity", [](const ExplainedLoop& loop) { return loop.planarity; }},
    {"mean_probability", [](const ExplainedLoop& loop) { return loop.mean_probability; }},
    {"hidden", share_of<Cause::kHidden>},
    {"opening", share_of<Cause::kOpening>},
    {"out_of_view", share_of<Cause::kOutOfView>},
    {"no_return", share_of<Cause::kNoReturn>},
    {"filtered", share_of<Cause::kFiltered>},
});

// What a person sorts and filters by in a spreadsheet or on a map: points to diameter.
inline constexpr std::span kTableMeasures = std::span(kLoopMeasures).first<5>();

struct LoopColour {
  std::uint8_t red, green, blue;
};

inline constexpr LoopColour kHoleColour{230, 80, 30};
inline constexpr LoopColour kOuterColour{30, 130, 230};

constexpr const LoopColour& colour_of(LoopKind kind) {
  return kind == LoopKind::kHole ? kHoleColour : kOuterColour;
}

}  // namespace lacuna::io
