// SPDX-License-Identifier: Apache-2.0
// Sorts batches of numbers lane by lane.
#pragma once

#include "engine/simd/batch.hpp"

#include <cstddef>

namespace lacuna {

inline constexpr std::size_t kBatchesInRegisters = 32;  // more of them take much longer

// Sorts the numbers of each lane in ascending order. Not for NaN.
void sort_batches(Batch<double>* batches, std::size_t count);

}  // namespace lacuna
