// SPDX-License-Identifier: Apache-2.0
// The vocabulary of the tests of points.las.
#pragma once

#include "io/read/las/las_header.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {

inline constexpr std::size_t kResultBytes = 4 * 4 + 1 + 1 + 4;

// Records of random bytes: every field has values, and every bit is there.
inline std::vector<std::string> random_points(std::size_t count, std::size_t bytes, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<std::string> points;
  for (std::size_t i = 0; i < count; ++i) {
    std::string point = las_point(bytes, 0, 0, 0);
    for (std::size_t b = 0; b < bytes; ++b) point[b] = static_cast<char>(random());
    points.push_back(point);
  }
  return points;
}

inline LasFile file_of(int format, int minor, std::size_t extra_bytes = 0, unsigned seed = 1) {
  return {.minor = minor,
          .format = format,
          .points = random_points(5, io::las_point_bytes(format) + extra_bytes, seed),
          .records = {}};
}

inline std::string detect_to(const ScratchFolder& folder, const io::ScanFiles& scan, std::size_t rows,
                             const io::FilesConfig& config) {
  io::write_results(FakeDetection().with_results(rows), scan, config, folder / "out");
  return read_file(folder / "out" / "points" / "a.las");
}

// The bytes of point i, without results.
inline std::string point_of(const std::string& las, std::size_t i, std::size_t bytes) {
  const std::size_t record = at<std::uint16_t>(las, 105);
  return las.substr(at<std::uint32_t>(las, 96) + i * record, bytes);
}

inline void check_columns(const Table& input, const Table& output) {
  for (const std::string& name : input.names) {
    INFO(name);
    CHECK(same_numbers(input.column(name), output.column(name)));
  }
}

}  // namespace lacuna::test
