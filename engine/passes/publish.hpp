// The results in the order of the input, ready to be written.
#pragma once

#include "engine/data/detection.hpp"
#include "engine/passes/coherence.hpp"
#include "engine/passes/measure.hpp"

#include <memory>
#include <optional>

namespace lacuna {

// `boundary`: the coherent points. `turned`: rows whose normal is to be turned round. Fills in the counts
// of boundary points and loops and takes what the result needs out of the other stages.
std::unique_ptr<Detection> publish(EvaluatedScan scan, const TileStore& store, const RowSet& boundary,
                                   MeasuredLoops loops, std::optional<RowSet> turned, Summary summary,
                                   Job& job);

}  // namespace lacuna
