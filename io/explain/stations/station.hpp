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
// of such names. `layouts` are those of the files. Throws `Error`, also where a station has a number and no
// file of it has such a column.
std::vector<Station> read_stations(const std::filesystem::path& list,
                                   std::span<const std::filesystem::path> files,
                                   std::span<const RowLayout> layouts);

// Returns the value of each row in the column `scan` or `point_source_id`; empty if the layout has neither.
std::vector<double> sources_of(const RowBatch& rows, const RowLayout& layout);

}  // namespace lacuna::io
