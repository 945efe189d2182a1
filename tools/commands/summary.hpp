// SPDX-License-Identifier: Apache-2.0
// What a person reads after a run: its summary, the state of a workspace, the answer for an area.
#pragma once

#include "engine/kept_state.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/scan/scan_files.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace lacuna::tools {

// The summary that a person reads after a run.

// Returns the counts of loops, the largest holes by area, and facts of the scan and of the run.
std::string print_summary(const io::ExplainedDetection& detection, const io::ScanFiles& scan, double seconds);

// Returns points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const io::FilteredOut& filtered);

// lacuna status and lacuna clean: the content of a workspace, and its removal.

// Returns "level 0: 12 of 20 tiles evaluated; level 1: ...".
std::string print_state(const KeptState& state);

// The check of an area as a person reads it.

// "covered", or "voids: 3 of 2.8 m or more (2 holes, 1 open), 1 more in exceptions", or "not decided" with
// its reasons.
std::string print_answer(const io::AreaCheck& check, std::string_view unit);

// "12,300 m², 98.7 % of it covered; 45,600 points", without the share where the answer is not decided.
// Points that take no part follow, if there are any.
std::string print_covered(const io::AreaCheck& check, std::string_view unit);

// "of the voids that count, 120 m² (34.1 %) lie in buildings"; a line for each class.
std::string print_classes(const io::AreaCheck& check, std::string_view unit);

// Returns what the figures rest on, a line for each thing, and what the check does not show.
std::string print_basis(const io::AreaCheck& check);

// Returns lines for points that cover nothing as their heights lie apart, and for densities that may be
// wrong.
std::vector<std::string> area_warnings(const io::AreaCheck& check, std::string_view unit);

// The ten largest voids as a table; empty without a void.
std::string print_voids(const io::AreaCheck& check, std::string_view unit);

}  // namespace lacuna::tools
