// SPDX-License-Identifier: Apache-2.0
// The summary that a person reads after a run.
#pragma once

#include "engine/run/disk_space.hpp"
#include "io/scan/file_scan.hpp"
#include "io/stations/cause.hpp"

#include <string>

namespace lacuna::tools {

// Returns the findings, the largest holes by area, outer curves as sums; then counts, and time per phase.
std::string print_summary(const io::ExplainedDetection& detection, const io::FileScan& scan,
                          double write_seconds, double total_seconds);

// Returns the length that is "long" in a scan of this extent: the power of ten nearest to a twentieth of it.
// Returns 0 without an extent.
double length_bound(double extent);

// Returns points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const io::FilteredOut& filtered);

}  // namespace lacuna::tools
