// SPDX-License-Identifier: Apache-2.0
// Surfaces with holes whose true loops are known, of any size.
#pragma once

#include "bench/synth/surface_options.hpp"

#include <cstdint>
#include <filesystem>

namespace lacuna::synth {

struct SurfaceSummary {
  std::uint64_t points = 0;
  std::uint64_t loops = 0;
  std::filesystem::path truth;
};

// Writes the surface and the file of its true loops: a comment, then one loop per line, the 0-based ids of
// its points. Every point is a function of the seed and its number alone. So the order changes only ids, and
// memory grows with the loops, not with the points. Throws `Error` for options that make no surface and for
// files that cannot be written.
SurfaceSummary write_surface(const SurfaceOptions& options);

}  // namespace lacuna::synth
