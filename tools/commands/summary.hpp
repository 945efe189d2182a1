// SPDX-License-Identifier: Apache-2.0
// The summary that a person reads after a run.
#pragma once

#include "io/explain/stations/cause.hpp"
#include "io/read/scan/scan_files.hpp"

#include <string>

namespace lacuna::tools {

// Returns the counts of loops, the largest holes by area, and facts of the scan and of the run.
std::string print_summary(const io::ExplainedDetection& detection, const io::ScanFiles& scan, double seconds);

// Returns points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const io::FilteredOut& filtered);

}  // namespace lacuna::tools
