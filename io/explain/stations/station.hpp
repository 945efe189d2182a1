// SPDX-License-Identifier: Apache-2.0
// Stations: the places of scanners, the points that each of them measured, and the lists that state them.
//
// In a list, blanks, commas or semicolons divide the fields; commas between digits are decimal ones where
// blanks or semicolons divide. Lines that begin with # are comments. A first line without numbers is a
// header.
#pragma once

#include "io/read/files/input_file.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

inline constexpr std::string_view kFieldDivisors = " \t\r,;";

inline constexpr double kFarthest = 1e12;  // coordinate of a place that is allowed
// Reads a number from -most to most. Returns the reason if it is none, else an empty text.
std::string read_number(std::string_view field, double most, double& number);

using Fields = std::span<const std::string_view>;

class ListLines {
 public:
  // `needed`: what a line must have, for errors. Throws `Error` as InputFile does.
  ListLines(const std::filesystem::path& list, std::string_view needed) : in_(list), needed_(needed) {}

  // Returns the fields of the next line that is neither blank nor a comment nor a header; valid until the
  // next call. Returns nothing at the end.
  std::optional<Fields> next();

  // Reads three numbers of at most kFarthest. Throws `Error` with the line.
  Eigen::Vector3d parse_place(Fields xyz) const;

  // Throws `Error` with the last line, the reason and what is needed; without a reason, this alone.
  [[noreturn]] void fail(std::string reason = {}) const;
  // Throws `Error` with the file alone.
  [[noreturn]] void fail_empty(const std::string& reason) const;
  const InputFile& in() const { return in_; }

 private:
  InputFile in_;
  std::string_view needed_;
  bool is_first_ = true;
  std::vector<std::string_view> fields_;
};

struct ListedPosition {
  std::string name;  // empty without a name
  Eigen::Vector3d position{0, 0, 0};
};

// Reads a place for a scanner from each line: x y z, or a name without blanks and x y z. Places are in the
// order of the file. Throws `Error`, also if there is no place.
std::vector<ListedPosition> read_places(const std::filesystem::path& list);

struct Station {
  std::string name;
  Eigen::Vector3d place{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};    // unit: the scanner turns around it
  std::optional<std::size_t> file;  // index of the file with its points; empty: any file
  std::optional<std::uint32_t>
      source;  // its number in the column `scan` or `point_source_id`; empty: all rows
};

// Reads the stations that the user states, one on each line: a name without blanks, x y z, and its points.
// The points are a file name, a number in the column `scan` or `point_source_id`, or both in this order. A
// single station needs neither, and no name. Blanks, commas or semicolons divide the fields; lines that begin
// with # are comments. A first line without numbers is a header. File names are names in `files`, or the ends
// of such names. `layouts`: of the files. Throws `Error`, also where a station has a number and no
// file of it has such a column.
std::vector<Station> read_stations(const std::filesystem::path& list,
                                   std::span<const std::filesystem::path> files,
                                   std::span<const RowLayout> layouts);

// Returns the value of each row in the column `scan` or `point_source_id`; empty if the layout has neither.
std::vector<double> sources_of(const RowBatch& rows, const RowLayout& layout);

// The path of a moving scanner, and the directions in which it measures.

// A path in one part or several, such as the lines of a flight. A new part begins after ten times the median
// interval of its times.
class Trajectory {
 public:
  // Rows of a file that are not of the path.
  struct LeftOut {
    std::uint64_t rows = 0;
    double time = 0;  // of the first
  };
  // `times` ascend, with a place each; at least two.
  Trajectory(std::vector<double> times, std::vector<Eigen::Vector3d> places, LeftOut left_out = {0, 0});

  const LeftOut& left_out() const { return left_out_; }

  double first_time() const { return times_.front(); }
  double last_time() const { return times_.back(); }
  double length() const { return lengths_.back(); }  // with the ways between parts
  // Returns how far along the path the scanner was; nothing if the path has no part at this time.
  std::optional<double> length_at(double time) const;
  Eigen::Vector3d place_at(double length) const;
  // Returns the axes at a place of the path: forward, to the left and upwards; they are rows of a rotation.
  // Forward is the direction between the places of its part that are `reach` before it and after it.
  Eigen::Matrix3d axes_at(double length, double reach) const;

 private:
  std::vector<double> times_, lengths_;  // lengths: from the first place
  std::vector<Eigen::Vector3d> places_;
  double longest_interval_ = 0;              // within a part
  std::vector<std::size_t> first_of_parts_;  // and the number of places
  LeftOut left_out_;
};

// Reads a file whose columns have names: a time (find_time in io/read/rows/column_rules.hpp), x, y and z, and
// any others. Headers, comments and names are as in scans of text; tx, ty and tz are names of the position,
// too. Rows are in any order. Rows off the path are left out, such as 0 0 0 where a receiver had no position.
// A way there takes a hundred times the median speed, and ten times the speeds below. At most a fifth of the
// rows is left out, or none. Returns nothing if the file names no time: then it lists stations. Throws
// `Error`, also for binary files, and for more lines than `memory` has space for.
std::optional<Trajectory> read_trajectory(const std::filesystem::path& file, std::uint64_t memory);

// The directions from a moving scanner in which it measures, in the axes of its path. A scanner with a
// turning mirror has a thin band of them.
class SweptDirections {
 public:
  SweptDirections();
  void add(const Eigen::Vector3d& direction);  // not 0
  // Keeps the cells of 1.8 degrees with more than a fiftieth of the directions of the fullest one.
  void finish();
  bool contains(const Eigen::Vector3d& direction) const;  // once finished

 private:
  std::vector<std::uint32_t> counts_;
  std::vector<bool> is_swept_;
};

}  // namespace lacuna::io
