// SPDX-License-Identifier: Apache-2.0
// A binary PLY of points, streamed: the count is filled in at the end.
#pragma once

#include "bench/synth/vec3.hpp"
#include "io/read/files/output_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lacuna::synth {

enum class Coordinates { kFloat, kDouble };
// Columns besides the position: none; uchar scan and float intensity; or these and double gps_time.
enum class Extras { kNone, kScan, kScanAndTime };

// Each file of a PlyOutput begins with this text, by which a program recognises an earlier one.
inline constexpr std::string_view kScanMark = "ply\nformat binary_little_endian 1.0\ncomment lacuna synth ";

// Rows are little-endian: x y z [scan intensity [gps_time]].
class PlyOutput {
 public:
  PlyOutput(io::OutputFile& file, Coordinates coordinates, Extras extras);

  void add(Vec3 position);
  void add(Vec3 position, std::uint8_t scan, float intensity, double time);  // time: used if rows have it
  std::uint64_t count() const { return count_; }

  void finish();  // fills the count in

 private:
  std::string header() const;

  io::OutputFile& file_;
  Coordinates coordinates_;
  Extras extras_;
  std::uint64_t count_ = 0;
};

}  // namespace lacuna::synth
