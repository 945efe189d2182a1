// SPDX-License-Identifier: Apache-2.0
// The vocabulary of the tests of points.las.
#pragma once

#include "io/results/results.hpp"
#include "tests/io/io_support.hpp"
#include "tests/io/results/fake_detection.hpp"
#include "tests/support/las_file.hpp"

namespace lacuna::test {

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  REQUIRE(offset + sizeof value <= bytes.size());
  std::memcpy(&value, &bytes[offset], sizeof value);
  return value;
}

inline constexpr std::size_t kPointBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
inline constexpr std::size_t kResultBytes = 4 * 4 + 1 + 1 + 4;

inline io::FilesConfig las_config() {
  io::FilesConfig config;
  config.results.points = true;
  return config;
}

// An extended record: `head` of 60 bytes, then the data.
inline std::string extended_record(const std::string& user, std::uint16_t number, const std::string& data) {
  std::string bytes(60, '\0');
  std::memcpy(&bytes[2], user.data(), user.size());
  put<std::uint16_t>(bytes, 18, number);
  put<std::uint64_t>(bytes, 20, data.size());
  std::memcpy(&bytes[28], "what it is", 10);
  return bytes + data;
}

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
  LasFile las;
  las.minor = minor;
  las.format = format;
  las.points = random_points(5, kPointBytes[format] + extra_bytes, seed);
  return las;
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

inline bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

inline void check_columns(const Table& input, const Table& output) {
  for (const std::string& name : input.names) {
    INFO(name);
    CHECK(is_same(input.column(name), output.column(name)));
  }
}

}  // namespace lacuna::test
