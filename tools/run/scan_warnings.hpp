// SPDX-License-Identifier: Apache-2.0
// Warnings about a scan that is odd: not wrong, but hardly meant.
#pragma once

#include "engine/model/detection.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lacuna::tools {

// Returns io::name_of_crs, fit to be printed.
std::string crs_name(const std::string& crs);

// Throws `Error` if positions are longitude and latitude, because nothing of a run fits degrees. Throws, too,
// if lengths differ by more than 1 in 100 from true ones, at the first point of a file. This check is of
// projected systems, and needs lacuna_gis.so.
void require_lengths(const io::ScanFiles& scan);

// Returns, before a run, one line for each file that is given more than once, also by another name. Another
// line comes for each file whose coordinate reference system differs from the first. One line names all files
// without a system if others have one. One line names files with another unit, and one names files that
// contradict --crs or --unit. One names files whose z is in another unit. Then come the notes of readers.
std::vector<std::string> input_warnings(const io::ScanFiles& scan);

// Warns before a run of a memory limit above the machine's memory.
std::vector<std::string> memory_warnings(const Config& config);

// A box of the scan as people and --bounds have it: six numbers with three digits of its extent. They are
// rounded outwards by at most one step of the last digit. `margin` is added on all sides.
std::string print_bounds(const Eigen::AlignedBox3d& box, double margin);

// Returns how many points lie far from all others, where, and which option leaves them out; empty without
// such points.
std::string stray_warning(const Strays& strays, double resolution);

// Returns how many loops are about as small as the gaps between points, and the --min-hole that leaves them
// out. It is empty where they are few, or less than half.
std::string small_loops_warning(const std::vector<LoopMeasures>& loops);

// Returns how many given normals do not fit, and what the run has done. It is empty for fewer than one in a
// hundred points, as at creases.
std::string normals_warning(const Counts& counts, NormalsUse use);

// Returns, after the scan was read, what readers found in its rows. One line names files that lie around 0 0
// 0 while they have viewpoints elsewhere. Others come where many points are left out as noise, and where
// --drop-origin dropped nothing. Then the scanner's place in a file is 0 0 0, which lies farther from the
// bounds of the points than these are wide.
std::vector<std::string> filter_warnings(const io::ScanFiles& scan, const io::ScanCounts& counts,
                                         const Eigen::AlignedBox3d& bounds);

// Names stations and trajectories that do not count, because they cannot have measured all of their points,
// or have none. Other lines are of rows of trajectories that are left out, and of stations that are far off.
// The last ones are of points of no station, and of what seems to be up, where it is not z.
std::vector<std::string> station_warnings(const std::vector<io::StationSummary>& stations,
                                          const io::PointsOfNone& of_none = {},
                                          const std::optional<io::Upward>& upward = {});

// Returns what seems to be up, and how the scan is turned.
std::string upward_warning(const io::Upward& upward);

// Returns a line where a scan of a thousand points or more has neither a hole nor an outer curve. The line
// says what is likelier. Neighbours are too few, the points lie on lines, the surface is closed, or the
// points are not on it. Empty where options leave curves out.
std::string nothing_warning(const Detection& detection, const SelectionConfig& selection);

// Returns the warnings of filter_warnings and nothing_warning after a run. Others are of strays, given
// normals that do not fit, and too few points for their neighbourhoods. The last ones are of coordinates in
// steps too wide for their spacing, and of files that do not fit, as without their poses.
std::vector<std::string> scan_warnings(const io::ScanFiles& scan, const io::ExplainedDetection& detection,
                                       const io::FilesConfig& config);

// Returns a line where coordinates are in steps of more than half of the distance to the neighbours, and this
// changes the surface. So it is for steps across a quarter of the surface, which divide it into layers. So it
// is where half of the points share places, and for single precision far from 0 0 0. A grid in x and y is no
// such case. Steps are those of the sample: the median over its points of the gap to the next value. Empty
// for other scans.
std::string steps_warning(const Detection& detection, bool is_single_precision);

}  // namespace lacuna::tools
