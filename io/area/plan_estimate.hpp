// SPDX-License-Identifier: Apache-2.0
// estimate_plan: what a survey from above leaves out of its plan, by a sample of its points.
#pragma once

#include "engine/export.hpp"
#include "engine/model/detection.hpp"

#include <optional>

namespace lacuna::io {

// Lengths are in units of the scan.
struct PlanEstimate {
  double area = 0;       // of the scan's outline
  double uncovered = 0;  // of it, within voids
  double widest = 0;     // diameter of the largest circle that fits into a void
};

// Returns nothing unless the scan is one from above. Then its height is at most a quarter of the shorter side
// of its plan. Its surface is at most twice as large as the plan. Nothing, too, of fewer than 1,000 points,
// with a memory limit of less than 256 MiB, and where lacuna_gis.so is missing or fails. Voids have six
// spacings of the sample at least, since random points leave no such circle. Memory: some 20 bits for each
// point of the sample. Cost: linear in the sample.
LACUNA_API std::optional<PlanEstimate> estimate_plan(const Detection& detection);

}  // namespace lacuna::io
