// SPDX-License-Identifier: Apache-2.0
// The lines of a list of stations or places, and such places. Blanks, commas or semicolons divide the fields;
// commas between digits are decimal ones where blanks or semicolons divide. Lines that begin with # are
// comments. A first line without numbers is a header.
#pragma once

#include "io/read/files/input_file.hpp"

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

}  // namespace lacuna::io
