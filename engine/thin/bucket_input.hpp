// Survey, thin and bucket: the input in tiles on disk, at the resolution of the run.
#pragma once

#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/thin_scan.hpp"

#include <cstdint>
#include <optional>

namespace lacuna {

struct Bucketed {
  std::optional<ThinnedScan> thinned;  // only at a resolution
  SurveyedScan survey;                 // of the points in the store
  std::uint64_t tile_points;           // in effect
  TileStore store;                     // all distinct points or, at a resolution, the representatives
};

// At the resolution that the config has, or that the lines of the scan leave (docs/method.md, D). By the
// paper every point counts unless the config has a resolution. Reads the input twice: for the survey and the
// tiles, or for the representatives. Four times where a resolution is chosen. An input that reads slowly is
// read once, and kept in the workspace meanwhile (engine/store/kept_scan.hpp). Throws `Error`.
Bucketed bucket_input(PointSource& input, Job& job);

}  // namespace lacuna
