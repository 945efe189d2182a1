// Sorting rows of numbers column by column.
#pragma once

#include "engine/simd/batch.hpp"

#include <cstddef>

namespace lacuna {

inline constexpr std::size_t kRowsInRegisters = 32;  // more of them take much longer

// The numbers of each column in ascending order. Not for NaN.
void sort_rows(Batch<double>* rows, std::size_t count);

}  // namespace lacuna
