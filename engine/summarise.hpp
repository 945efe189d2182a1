// The numbers of a run.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/thin/bucket_input.hpp"

namespace lacuna {

// Counts and bounds of the input, not of its representatives; tiles, threads and memory limit in effect.
Summary summarise(const Bucketed& bucketed, const Job& job);

// What the evaluation and the search for loops have found. `eps`: in effect.
void add_findings(const Totals& totals, const FoundLoops& found, double eps, Summary& summary);

}  // namespace lacuna
