// SPDX-License-Identifier: Apache-2.0
// Finds the hole of a plane, and prints it.
#include "plane_with_hole.hpp"

#include <cstdio>

#include <lacuna/lacuna.hpp>

int main() {
  try {
    lacuna::Config config;
    config.scale.min_hole = 10;          // as --min-hole 10
    config.selection.holes_only = true;  // without the outer boundary of the square
    const lacuna::Holes found = lacuna::find_holes(plane_with_hole(), config);
    for (const lacuna::ReportedLoop& loop : found.loops) print_hole(loop.measures, loop.points.size());
  } catch (const lacuna::Error& error) {
    std::fprintf(stderr, "find_holes: %s\n", error.what());
    return 1;
  }
}
