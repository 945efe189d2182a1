// SPDX-License-Identifier: Apache-2.0
// own_frames: files whose points are in the axes of their own scanners, as where poses were forgotten.
#pragma once

#include "engine/model/detection.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace lacuna::io {

// Returns the first two files of which each can have been measured from 0 0 0, and both together cannot. Each
// has one range in four of five directions. They share half of their directions. In three of ten of these,
// their ranges differ by a fifth. `ends`: the first id behind each file. The sample of at most eight files is
// compared, in 300 kB for each.
std::optional<std::pair<std::size_t, std::size_t>> own_frames(const Detection& detection,
                                                              std::span<const std::uint64_t> ends);

}  // namespace lacuna::io
