// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy: .npy.
#pragma once

#include "io/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_numpy(const FileStart& start);

// Reads an array of N x 3 or more numbers, in the order of C or Fortran, whose first columns are x y z. A
// structured array has names for its columns. All columns of a plain array have its type; 64-bit integers
// become kFloat64. Memory is bounded by kBatchBytes.
std::unique_ptr<ScanReader> open_numpy(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
