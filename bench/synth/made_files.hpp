// SPDX-License-Identifier: Apache-2.0
// made_files: the two files of a synthetic scan: its points as a binary PLY, and its true loops as text.
//
// Idea: points are streamed, and their count is filled in at the end.
#pragma once

#include "bench/evaluation/loops_reader.hpp"
#include "bench/synth/arithmetic.hpp"
#include "io/read/files/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::synth {

// Throws `UsageError` unless it holds.
void require(bool holds, const std::string& message);

enum class Coordinates { kFloat, kDouble };
// Columns besides the position: none; uchar scan and float intensity; or these and double gps_time.
enum class Extras { kNone, kScan, kScanAndTime };

// Each file of a PlyOutput begins with this text, by which a program recognises an earlier one.
inline constexpr std::string_view kScanMark = "ply\nformat binary_little_endian 1.0\ncomment lacuna synth ";

// Rows are little-endian: x y z [scan intensity [gps_time]].
class PlyOutput {
 public:
  PlyOutput(io::OutputFile& file, Coordinates coordinates, Extras extras);

  // Rows take what they have of these.
  void add(Vec3 position, std::uint8_t scan = 0, float intensity = 0, double time = 0);
  std::uint64_t count() const { return count_; }

  void finish();  // fills the count in

 private:
  std::string header() const;

  io::OutputFile& file_;
  Coordinates coordinates_;
  Extras extras_;
  std::uint64_t count_ = 0;
};

// The points of a closed loop in order: their ids, or before points are written, their numbers.
using NumberLoop = std::vector<std::uint64_t>;

// Returns the loop without the shorter way between two visits of one point, until each point has one visit.
NumberLoop without_returns(NumberLoop loop);

// Makes the loop begin with its smallest id, towards the smaller neighbour of this id.
void to_canonical(NumberLoop& ids);

// What was made.
struct Made {
  std::uint64_t points = 0;
  std::uint64_t loops = 0;  // true ones
  std::filesystem::path truth;
  std::uint64_t rays = 0;  // of a scanner
};

// Each file of true loops begins with this text, by which a program recognises an earlier one.
inline constexpr std::string_view kTruthMark = evaluation::kLoopsTextMark;

// Returns `truth`, or NAME.loops.txt next to the scan if `truth` is empty. Throws `Error` if that is the scan
// itself.
std::filesystem::path truth_file_of(const std::filesystem::path& scan, const std::filesystem::path& truth);

// Writes the whole file, as evaluation::read_true_rows() reads it. Narrow loops have no name.
void write_truth(io::OutputFile& file, const std::filesystem::path& scan, const evaluation::TrueRows& rows);

}  // namespace lacuna::synth
