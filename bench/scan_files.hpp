// SPDX-License-Identifier: Apache-2.0
// Writes one sample in each format that Lacuna reads, to measure the readers.
#pragma once

#include "engine/model/points.hpp"

#include <filesystem>
#include <span>

namespace lacuna {

struct SampleFormat {
  const char* name;    // such as "LAZ 1.4, format 7"
  const char* ending;  // of a file name
  // The sample has positions, and intensity, colours and times if the format has them. It is never a file of
  // more than 4 GB. PTX, PCD and STL have single precision or as many digits.
  void (*write)(const PointBatch& sample, const std::filesystem::path& file);
};

std::span<const SampleFormat> sample_formats();

}  // namespace lacuna
