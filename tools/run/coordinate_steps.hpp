// SPDX-License-Identifier: Apache-2.0
// Warns of coordinates in steps that are wide for the spacing of the points.
#pragma once

#include "engine/model/detection.hpp"

#include <string>

namespace lacuna::tools {

// Returns a line where coordinates are in steps of more than half of the distance to the neighbours, and this
// changes the surface. So it is for steps across a quarter of the surface, which divide it into layers. So it
// is where half of the points share places, and for single precision far from 0 0 0. A grid in x and y is no
// such case. Steps are those of the sample: the median over its points of the gap to the next value. Empty
// for other scans.
std::string steps_warning(const Detection& detection, bool is_single_precision);

}  // namespace lacuna::tools
