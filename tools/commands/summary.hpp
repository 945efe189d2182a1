// SPDX-License-Identifier: Apache-2.0
// The summary that a person reads after a run.
#pragma once

#include "engine/run/disk_space.hpp"
#include "io/scan/file_scan.hpp"
#include "io/stations/cause.hpp"

#include <string>
#include <string_view>

namespace lacuna::tools {

struct RunTimes {
  double write_seconds = 0;
  double total_seconds = 0;
};

// Returns the findings, the largest holes by area, outer curves as sums; then counts, and time per phase.
// `unit` is the unit of the scan's coordinates, such as "m"; empty if not known.
std::string print_summary(const io::ExplainedDetection& detection, const io::FileScan& scan, const RunTimes& times,
                          std::string_view unit = "");

// Returns the length that is "long" in a scan of this extent: the power of ten nearest to a twentieth of it.
// Returns 0 without an extent.
double length_bound(double extent);

// Returns points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const io::FilteredOut& filtered);

}  // namespace lacuna::tools
