// SPDX-License-Identifier: Apache-2.0
// One sample in each format that is read, to measure the readers.
#pragma once

#include "engine/model/points.hpp"

#include <filesystem>
#include <span>

namespace lacuna {

struct SampleFormat {
  const char* name;    // "LAZ 1.4, format 7"
  const char* ending;  // of a file name
  // Positions, and intensity, colours and times where the format has them. Files of more than 4 GB are not
  // made. PTX, PCD and STL have single precision or as many digits.
  void (*write)(const PointBatch& sample, const std::filesystem::path& file);
};

std::span<const SampleFormat> sample_formats();

}  // namespace lacuna
